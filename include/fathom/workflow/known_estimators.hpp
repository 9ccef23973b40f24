#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/datasets/fingerprint.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom::workflow {

/// What becomes of the plug-ins that a configuration names. Loading one executes it.
enum class NamedPlugins { loaded, left_out };

/// The estimators that a program knows: those that it begins with, and those of plug-ins that it
/// loads. A value; code that is loaded stays in the process as long as that lives.
class KnownEstimators {
 public:
  explicit KnownEstimators(EstimatorRegistry begin) : registry_(std::move(begin)) {}

  const EstimatorRegistry& registry() const { return registry_; }

  /// A shared object or a .py file. What is loaded already stays as it is. Throws InputError, also
  /// where the content of such a file has changed since.
  void load(const std::filesystem::path& file);

  /// The plug-ins that the environment's FATHOM_PLUGIN_PATH names, files and folders. What cannot
  /// be loaded is left out: one that another program needs must not stop this one. Returns a line
  /// for each that is.
  [[nodiscard]] std::vector<std::string> load_search_path();

  /// These plug-ins, which are put under `plugins` of the settings, too, and those that stand
  /// there: all where the user's own word has it so, else those of --set alone; of the others the
  /// estimators are known by name (add_unloaded). Throws InputError at the setting where it is no
  /// list of words.
  void load(Settings& settings, const std::vector<std::string>& files, NamedPlugins named);

 private:
  EstimatorRegistry registry_;
  std::map<std::filesystem::path, Fingerprint> loaded_;  ///< with the content at that time
};

}  // namespace fathom::workflow
