#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"

namespace fathom {

/// The estimate at every frame, stamped: its keyframe's ⊕ the dead reckoning since. Nothing for a
/// pose graph.
std::vector<StampedPose> frame_trajectory(const Recording& recording,
                                          const std::vector<Pose>& keyframes);

/// The estimate at every keyframe, stamped.
std::vector<StampedPose> keyframe_trajectory(const Recording& recording,
                                             const std::vector<Pose>& poses);

/// Writes what is the same for every estimator: `dead_reckoning.tum`, `measurements.g2o`
/// with `measurements.shared`, and `ids.csv`, `mask.png` and `ground_truth.tum` where there are
/// such ids, a mask and truth. Throws InputError.
void write_recording(const std::filesystem::path& folder, const Recording& recording);

/// The files of a run that not every run has, to be removed from a folder that is used again.
const std::vector<std::string>& optional_run_files();

/// What looks wrong with a run, as the `run.json` of its folder says; nothing where there is none.
std::vector<std::string> remarks_of_run(const std::filesystem::path& folder);

/// What a run's pictures and altitudes depend on: the settings `seed` and those below `dataset`, of
/// the run whose folder this is, out of its `run.json`. Throws InputError where there is none,
/// where it is not that of a run, or where the run was over a pose graph, which has no pictures.
Settings data_settings_of_run(const std::filesystem::path& folder);

/// Writes the text files of one estimator's run into an existing folder (docs/outputs.md):
/// `trajectory.tum`, `dead_reckoning.tum`, `measurements.g2o`, `metrics.json`, `run.json`, and
/// `frames.tum` and `ground_truth.tum` where there are frames and truth. Throws InputError.
void write_run(const std::filesystem::path& folder, const Recording& recording,
               const Result& result, const std::string& manifest);

}  // namespace fathom
