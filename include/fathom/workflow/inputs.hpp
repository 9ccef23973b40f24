#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/datasets/fingerprint.hpp"
#include "fathom/estimation/registry.hpp"

namespace fathom::workflow {

/// Of a configuration (YAML) its settings; of a folder of pictures, in the EuRoC/ASL layout or
/// plain, and of a pose graph (.g2o, .graph) that it is the data set; of an empty path none. Throws
/// InputError.
Settings settings_of(const std::filesystem::path& path);

/// Throws InputError naming `source` where nothing is set: an empty file is no survey.
void require_keys(const Settings& settings, const std::string& source);

/// What a configuration from `path` has read: itself, its data set, its floor. No output may
/// replace one of these.
std::vector<std::filesystem::path> inputs_of(const std::filesystem::path& path,
                                             const Settings& settings);

/// What a run of it is called: the name of a file without its ending, that of a folder as it is, or
/// that of the folder around a mav0.
std::string stem_of(const std::filesystem::path& path);

/// The hashes of data, and of the plug-ins and programs that do the work of these estimators.
Fingerprint with_code(Fingerprint data, const std::vector<EstimatorConfiguration>& all,
                      const EstimatorRegistry& registry);

/// All that may run in these: those that are compared, and those that select loop candidates.
std::vector<EstimatorConfiguration> estimators_in(const std::vector<Configuration>& cells);

}  // namespace fathom::workflow
