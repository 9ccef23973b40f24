#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/study/recording.hpp"
#include "fathom/study/result.hpp"

namespace fathom {

/// The estimate at every keyframe, stamped.
std::vector<StampedPose> keyframe_trajectory(const Recording& recording,
                                             const std::vector<Pose>& poses);

/// Writes what is the same for every estimator: `dead_reckoning.tum`, `measurements.g2o`, and
/// `ground_truth.tum` where there is truth. Throws InputError.
void write_recording(const std::filesystem::path& folder, const Recording& recording);

/// The files of a run that not every run has, to be removed from a folder that is used again.
const std::vector<std::string>& optional_run_files();

/// Writes the text files of one estimator's run into an existing folder (docs/formats.md):
/// `trajectory.tum`, `dead_reckoning.tum`, `measurements.g2o`, `metrics.json`, `run.json`, and
/// `frames.tum` and `ground_truth.tum` where there are frames and truth. Throws InputError.
void write_run(const std::filesystem::path& folder, const Recording& recording,
               const Result& result, const std::string& manifest);

}  // namespace fathom
