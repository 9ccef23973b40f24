#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"
#include "fathom/report/trajectory_plot.hpp"

namespace fathom::workflow {

/// What the picture of a run or comparison shows: ground truth and dead reckoning, the estimates,
/// and, with details, the loops used and 2σ ellipses of the first one. All are in the frame of
/// keyframe 0. `first_place` is that of the first estimate in its study, by which it has its line.
TrajectoryPlot trajectory_plot(const std::string& title, const Recording& recording,
                               const std::vector<Result>& results, std::size_t first_place = 0,
                               bool with_details = true);

/// The same as a PNG.
void write_trajectory_picture(const std::filesystem::path& path, const std::string& title,
                              const Recording& recording, const std::vector<Result>& results,
                              std::size_t first_place = 0, bool with_details = true);

}  // namespace fathom::workflow
