#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/flags.hpp"
#include "fathom/configuration/config_file.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/front_end/registration_store.hpp"

namespace fathom {

struct Context;

/// --plugin FILE of a command, each use adds one.
void add_plugins_to(Command& command, std::vector<std::string>& files);

/// --drop-self-edges of a command that reads pose graphs.
void add_drop_self_edges_to(Command& command, bool& field);

/// The flags of all commands that read a configuration or run an estimator.
struct CommonFlags {
  std::vector<std::string> overrides;  ///< --set KEY=VALUE
  std::vector<std::string> plugins;    ///< --plugin FILE
  std::optional<int> seed;
  bool quiet = false;
  std::string out;

  void add_settings_to(Command& command, Context& context);
  void add_out_to(Command& command, const std::string& what);

  /// The file's settings (none for an empty path; of a folder, that it is the data set), then
  /// --set, then --seed. Plug-ins that are named there or by --plugin are loaded.
  Settings settings(const std::string& path) const;
  /// Those known now.
  const EstimatorRegistry& estimators() const;
  /// --out, or `runs/` and a name of its own.
  std::string folder_or(const std::string& name) const;

 private:
  Context* context_ = nullptr;
};

/// The registrations kept in a folder. Where it cannot be used a note says so, unless quiet, and
/// they are kept in memory only.
std::unique_ptr<RegistrationStore> open_registrations(const std::filesystem::path& folder,
                                                      bool quiet);

}  // namespace fathom
