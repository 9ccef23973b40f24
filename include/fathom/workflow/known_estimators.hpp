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

  /// The plug-ins that `plugins` in a configuration names, and these, which are put there, too.
  /// Throws InputError at the setting where it is no list of words.
  void load(Settings& settings, const std::vector<std::string>& files);

 private:
  EstimatorRegistry registry_;
  std::map<std::filesystem::path, Fingerprint> loaded_;  ///< with the content at that time
};

}  // namespace fathom::workflow
