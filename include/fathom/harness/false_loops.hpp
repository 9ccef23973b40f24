#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fathom/estimation/estimator.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/measurements/spoil.hpp"

namespace fathom {

/// Poses against which loops are false: the ground truth of the keyframes or, where it is not
/// known, the batch optimum of the log from dead reckoning.
std::vector<Pose> reference_poses(const Recording& recording, const EstimatorRegistry& registry);

/// Adds false loops to a recording (spoil) and notes which they are. A log without a loop stays as
/// it is.
void spoil_recording(Recording& recording, const SpoilOptions& options,
                     const EstimatorRegistry& registry, std::uint64_t seed, std::uint64_t trial);

/// The list of false loops beside a spoilt graph: `registration,from,to`, the index among the
/// graph's registrations in order of arrival, from 0 on, and the ids of its poses.
std::string false_loops_csv(const Spoiled& spoiled);

/// Reads it for a graph. Throws InputError with file and line where it does not belong to it.
std::vector<bool> read_false_loops(const std::filesystem::path& path, const MeasurementLog& log);

}  // namespace fathom
