// Where keyframe 0 is by the first readings.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include <gtest/gtest.h>

#include "datasets/reckoned_frames.hpp"
#include "fathom/core/random.hpp"
#include "fathom/datasets/data_set.hpp"
#include "fathom/datasets/reading_carrier.hpp"
#include "fathom/datasets/simulated_sensors.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::frames_with_holes;
using test::homogeneous;
using test::input_error_of;
using test::kFrame;
using test::over;
using test::t2v;

TEST(StartOf, WithoutReadingsItIsHeldAtZeroOrAsGiven) {
  const auto frames = frames_with_holes();
  EXPECT_TRUE(start_of({}, {}, over(frames)).is_fixed());
  EXPECT_EQ(start_of({}, {}, over(frames)).pose, Pose{});
  const StartPose given = start_of({1.0, 2.0, 0.5, 0.1, 0.02}, {}, over(frames));
  EXPECT_EQ(given.pose, (Pose{1.0, 2.0, 0.5}));
  EXPECT_LT((given.covariance.diagonal() - Eigen::Vector3d(0.01, 0.01, 0.0004)).norm(), 1e-15);
}

TEST(StartOf, FirstFixAndFirstHeadingSayWhereItIs) {
  const auto frames = frames_with_holes();
  const Pose truth{10.0, 20.0, -2.0};
  const Eigen::Matrix3d at_2 =
      homogeneous(truth) * homogeneous(frames[1].motion.mean) * homogeneous(frames[2].motion.mean);
  AbsoluteReadings readings;
  readings.headings = {{-7, 1.0, 0.01}, {kFrame, truth.theta + 0.3, 0.01}};
  readings.fixes = {{2 * kFrame, t2v(at_2).head<2>(), Eigen::Matrix2d::Identity()}};
  const StartPose start = start_of({}, readings, over(frames));
  EXPECT_LT(test::distance(start.pose, truth), 1e-12);
  // So wide that a reading hardly feels it.
  const double heading_variance = 1e-4 + frames[1].motion.covariance(2, 2);
  EXPECT_NEAR(start.covariance(2, 2), kStartWidth * kStartWidth * heading_variance, 1e-9);
  EXPECT_GT(start.covariance(0, 0), 1e4);
}

// Of the first fix, or of four among ten, jumps do not say where the survey begins; nor does a
// heading that is off.
TEST(StartOf, AJumpIsNoStart) {
  std::vector<DeadReckonedFrame> frames(30);
  const Eigen::Matrix3d Q = Eigen::Vector3d(1e-4, 1e-4, 1e-6).asDiagonal();
  const Pose truth{10.0, 20.0, -2.0};
  Pose X = truth;
  AbsoluteReadings readings;
  readings.lever_m = {1.0, 0.5};
  RandomStream random(3, "fixes");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const auto time_ns = static_cast<std::int64_t>(i) * kFrame;
    frames[i] = {time_ns, {{1.0, 0.0, 0.1}, Q}, false};
    if (i > 0) X = compose(X, frames[i].motion.mean);
    if (i % 2 == 1) continue;
    const bool jumps = i == 0 || i == 6 || i == 8 || i == 14;
    const Eigen::Vector2d noise(0.5 * random.normal(), 0.5 * random.normal());
    const Eigen::Vector2d jump =
        jumps ? Eigen::Vector2d(20.0, 3.0 * static_cast<double>(i)) : Eigen::Vector2d(0.0, 0.0);
    readings.fixes.push_back({time_ns, transform(X, readings.lever_m) + noise + jump,
                              0.25 * Eigen::Matrix2d::Identity()});
    readings.headings.push_back(
        {time_ns, wrap_angle(X.theta + 0.01 * random.normal() + (i == 0 ? 2.0 : 0.0)), 0.01});
  }
  const StartPose start = start_of({}, readings, over(frames));
  EXPECT_LT(test::distance(start.pose, truth), 1.5);
  EXPECT_NEAR(start.pose.theta, truth.theta, 0.04);
  // Narrow enough that a gate refuses the first fix.
  EXPECT_LT(start.covariance(0, 0), 1.2);
  EXPECT_GT(start.covariance(0, 0), 0.9);
  EXPECT_LT(start.covariance(2, 2), 1e-3);
}

TEST(StartOf, ACompassAloneLeavesThePositionToTheGauge) {
  const auto frames = frames_with_holes();
  AbsoluteReadings readings;
  readings.headings = {{0, 1.2, 0.01}};
  const StartPose start = start_of({}, readings, over(frames));
  EXPECT_EQ(start.pose, (Pose{0.0, 0.0, 1.2}));
  EXPECT_EQ(start.covariance(0, 0), kHeldSigma_m * kHeldSigma_m);
  EXPECT_NEAR(start.covariance(2, 2), 1.0, 1e-12);
  EXPECT_TRUE(is_positive_definite(start.covariance));
}

TEST(StartOf, RefusesWhatDoesNotDetermineIt) {
  const auto frames = frames_with_holes();
  AbsoluteReadings readings;
  readings.fixes = {{0, {1.0, 2.0}, Eigen::Matrix2d::Identity()}};
  EXPECT_EQ(input_error_of([&] { start_of({}, readings, over(frames)); }),
            "dataset.start.heading_rad: is missing: fixes alone do not say the heading of the "
            "first frame; expected it with dataset.start.sigma_rad, or headings of a compass");
  EXPECT_EQ(input_error_of([&] {
              start_of({1.0, std::nullopt, 0.0, 0, 0}, {}, over(frames));
            }),
            "dataset.start.y_m: is missing; x_m and y_m go together");
  EXPECT_EQ(input_error_of([&] {
              start_of({std::nullopt, std::nullopt, 0.0, 1.0, 0}, {}, over(frames));
            }),
            "dataset.start.sigma_m: is of no position; expected x_m and y_m with it");
  EXPECT_EQ(input_error_of([&] {
              start_of({1.0, 1.0, std::nullopt, 0.0, 0.1}, {}, over(frames));
            }),
            "dataset.start.sigma_rad: is of no heading; expected heading_rad with it");
}

// 400 draws about what is given; none of what is held, to the last bit.
TEST(DrawnStart, HasTheErrorsThatItsSigmasTell) {
  const StartOptions given{3.0, -2.0, 3.1, 0.5, 0.1};
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  for (std::uint64_t trial = 0; trial < 400; ++trial) {
    const StartOptions told = draw_start(given, 7, trial);
    EXPECT_EQ(told.sigma_m, 0.5);
    EXPECT_EQ(told.sigma_rad, 0.1);
    const Eigen::Vector3d e((*told.x_m - 3.0) / 0.5, (*told.y_m + 2.0) / 0.5,
                            wrap_angle(*told.heading_rad - 3.1) / 0.1);
    sum += e / 400.0;
    squares += e * e.transpose() / 400.0;
    const StartOptions held = draw_start({3.0, -2.0, 3.1, 0.0, 0.0}, 7, trial);
    EXPECT_EQ(held.x_m, 3.0);
    EXPECT_EQ(held.heading_rad, 3.1);
    // The size of one error changes no other draw.
    EXPECT_EQ(draw_start({3.0, -2.0, 3.1, 0.0, 0.1}, 7, trial).heading_rad, told.heading_rad);
  }
  EXPECT_LT(sum.cwiseAbs().maxCoeff(), 3.0 / std::sqrt(400.0));
  EXPECT_LT((squares - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
            3.0 * std::sqrt(2.0 / 400.0));
  EXPECT_FALSE(draw_start({}, 7, 0).x_m);
}

// Of both data sets that draw, about the truth: the origin.
TEST(DrawnStart, IsThatOfEachTrial) {
  const DataSetValues values{{"start.x_m", OptionValue::scalar("0")},
                             {"start.y_m", OptionValue::scalar("0")},
                             {"start.heading_rad", OptionValue::scalar("0")},
                             {"start.sigma_m", OptionValue::scalar("0.5")},
                             {"start.sigma_rad", OptionValue::scalar("0.1")}};
  const StartOptions told = draw_start({0.0, 0.0, 0.0, 0.5, 0.1}, 7, 3);
  const auto survey = find_data_set("simulated").open(values, 1);
  EXPECT_EQ(survey->trial(values, {7, 3}).start.x_m, told.x_m);
  EXPECT_NE(survey->trial(values, {7, 4}).start.x_m, told.x_m);
  const Trial log = find_data_set("simulated_log").open(values, 1)->trial(values, {7, 3});
  EXPECT_EQ(log.graph->log.origin(), (Pose{*told.x_m, *told.y_m, *told.heading_rad}));
  EXPECT_EQ(log.graph->ground_truth.front().pose, Pose{});
}

}  // namespace
}  // namespace fathom
