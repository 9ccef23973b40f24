#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom::workflow {

/// A configuration and a study for a folder of pictures.
struct InitRequest {
  std::filesystem::path survey;  ///< absolute, as it is to stand in both
  Settings settings;             ///< settings_of(survey), and what is known of it
  std::filesystem::path out;     ///< a folder
};

struct InitOutcome {
  std::vector<std::string> facts;     ///< what the front end will find
  std::vector<std::string> assumed;   ///< of what the folder does not say
  std::vector<std::string> warnings;  ///< what looks wrong
  std::filesystem::path run;          ///< for `run`
  std::filesystem::path study;        ///< for `compare`: all estimators
};

/// Writes run.yaml and study.yaml: the data set and every key of the front end, with its value and
/// meaning. Throws InputError, also where `survey` is no folder of pictures.
InitOutcome init(const InitRequest& request, const EstimatorRegistry& registry);

}  // namespace fathom::workflow
