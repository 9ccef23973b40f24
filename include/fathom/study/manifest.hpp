#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fathom/study/configuration.hpp"
#include "fathom/study/recording.hpp"
#include "fathom/study/result.hpp"

namespace fathom {

/// The version of Fathom.
std::string version();

/// What made a result: the content of run.json (docs/formats.md): versions, compiler and flags,
/// CPU, threads, seed, a hash of the measurements, and the whole configuration in force.
std::string manifest_json(const std::string& command_line,
                          const std::vector<std::pair<std::string, std::string>>& configuration,
                          const Recording& recording, const Result& result,
                          const EstimatorRegistry& registry);

/// Every option of an estimator with the value in force, by key.
std::vector<std::pair<std::string, std::string>> estimator_options(
    const EstimatorConfiguration& estimator, const EstimatorEntry& entry);

/// The manifest of a session of a study: versions, build, machine, command line, date, jobs.
std::string session_json(const std::string& command_line, int jobs);

/// FNV-1a, 64 bits, as 16 hexadecimal digits.
std::string hash_text(const std::string& content);

}  // namespace fathom
