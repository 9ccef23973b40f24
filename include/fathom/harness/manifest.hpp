#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/datasets/fingerprint.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/results/shard.hpp"

namespace fathom {

/// What made a result: the content of run.json (docs/outputs.md): versions, compiler and flags,
/// CPU, threads, seed, hashes of the data and of the measurements, and the whole configuration in
/// force.
std::string manifest_json(const std::string& command_line,
                          const std::vector<std::pair<std::string, std::string>>& configuration,
                          const Fingerprint& data, const Recording& recording, const Result& result,
                          const EstimatorRegistry& registry,
                          const std::vector<std::string>& remarks = {});

/// The manifest of a session of a study: versions, build, machine, command line, date, jobs.
std::string session_json(const std::string& command_line, int jobs);
/// The same of a session that does a shard, which it names.
std::string session_json(const ShardPlan& plan, int jobs);

}  // namespace fathom
