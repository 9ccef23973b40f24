#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/flags.hpp"
#include "fathom/configuration/config_file.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/workflow/known_estimators.hpp"
#include "fathom/workflow/named_code.hpp"

namespace fathom {

struct Context;

/// What a user lets a command load.
struct PluginFlags {
  std::vector<std::string> files;  ///< --plugin FILE
  bool allows_named = false;       ///< --allow-plugins: those that a configuration names, too

  void add_to(Command& command);
};

/// --plugin FILE of a command, each use adds one.
void add_plugins_to(Command& command, std::vector<std::string>& files);

/// A note of the code that a configuration names, and what becomes of it; none of none.
void print_named_code(const std::string& what, const workflow::NamedCode& code);

/// Loads what the flags and, for `loaded` or by --allow-plugins, the settings name. Unless quiet a
/// note says what the configuration has executed, for `loaded`, or what of it is left out.
void load_named_code(Settings& settings, const PluginFlags& flags, workflow::NamedPlugins named,
                     workflow::KnownEstimators& estimators, bool quiet);

/// --drop-self-edges of a command that reads pose graphs.
void add_drop_self_edges_to(Command& command, bool& field);

/// The flags of all commands that read a configuration or run an estimator.
struct CommonFlags {
  std::vector<std::string> overrides;  ///< --set KEY=VALUE
  PluginFlags plugins;
  std::optional<int> seed;
  bool quiet = false;
  std::string out;

  void add_settings_to(Command& command, Context& context);
  void add_out_to(Command& command, const std::string& what);

  /// The file's settings (none for an empty path; of a folder, that it is the data set), then
  /// --set, then --seed; with load_named_code.
  /// What is in the file or folder, --set and --seed.
  Settings given(const std::string& path) const;
  /// The same, with the estimators that go with it loaded.
  Settings settings(const std::string& path,
                    workflow::NamedPlugins named = workflow::NamedPlugins::left_out) const;
  /// Those known now.
  const EstimatorRegistry& estimators() const;
  /// --out, or `runs/` and a name of its own.
  std::string folder_or(const std::string& name) const;

 private:
  Context* context_ = nullptr;
};

/// --cache and --no-cache of a command that registers pictures.
struct CacheFlags {
  std::string folder;
  bool is_off = false;

  /// Both flags, in this order.
  std::array<Flag, 2> add_to(Command& command);
  /// The registrations of --cache, or the usual ones; none with --no-cache. Where the folder cannot
  /// be used a note says so, unless quiet, and they are kept in memory only.
  std::unique_ptr<RegistrationStore> open(bool quiet) const;
};

}  // namespace fathom
