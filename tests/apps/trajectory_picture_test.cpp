#include "fathom/workflow/trajectory_picture.hpp"

#include <algorithm>

#include <gtest/gtest.h>

namespace fathom {
namespace {

// Two keyframes and a loop between them.
Recording small_recording() {
  Recording recording;
  recording.log.add_keyframe(
      RelativePose::from_covariance(0, 1, {1.0, 0.0, 0.0}, Eigen::Matrix3d::Identity()));
  return recording;
}

Result with_a_loop(const std::string& name) {
  Result result;
  result.estimator.name = name;
  result.run.trajectory = {{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}};
  result.run.covariances = {Eigen::Matrix3d::Zero(), Eigen::Matrix3d::Identity()};
  result.run.loops.push_back({1, 0, LoopFate::used, {}});
  return result;
}

const PlotSeries& series_called(const TrajectoryPlot& plot, const std::string& name) {
  return *std::ranges::find(plot.series, name, &PlotSeries::name);
}

// A batch optimum that is drawn beside it takes nothing from the picture.
TEST(TrajectoryPicture, TheRunHasItsLoopsAndEllipses) {
  const std::vector<Result> results{with_a_loop("ekf"), with_a_loop("batch_optimum")};
  const auto plot = workflow::trajectory_plot("", small_recording(), results);
  EXPECT_EQ(series_called(plot, "ekf").loops.size(), 1u);
  EXPECT_EQ(series_called(plot, "ekf").covariances.size(), 2u);
  EXPECT_TRUE(series_called(plot, "batch_optimum").loops.empty());
  EXPECT_TRUE(series_called(plot, "batch_optimum").covariances.empty());
}

TEST(TrajectoryPicture, OfAComparisonHasLinesAlone) {
  const std::vector<Result> results{with_a_loop("ekf"), with_a_loop("graph")};
  const auto plot = workflow::trajectory_plot("", small_recording(), results, 0, false);
  EXPECT_TRUE(series_called(plot, "ekf").loops.empty());
  EXPECT_TRUE(series_called(plot, "ekf").covariances.empty());
}

}  // namespace
}  // namespace fathom
