#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/harness/recording.hpp"
#include "fathom/harness/result.hpp"

namespace fathom {

/// The picture of a run or comparison: ground truth and dead reckoning, the estimates, the loops
/// used and 2σ ellipses (of a single estimate only). All are drawn in the frame of keyframe 0.
void write_trajectory_picture(const std::filesystem::path& path, const std::string& title,
                              const Recording& recording, const std::vector<Result>& results);

/// One line an estimator, dead reckoning first, judged as the first estimator.
std::string result_table(const Recording& recording, const std::vector<Result>& results);

}  // namespace fathom
