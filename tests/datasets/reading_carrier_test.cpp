// Readings carried to keyframes, against homogeneous matrices and numerical derivatives.

#include "fathom/datasets/reading_carrier.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "datasets/reckoned_frames.hpp"
#include "fathom/core/random.hpp"
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

StartPose start_at(const Pose& pose) {
  return StartPose(pose);
}

Eigen::Matrix3d part(const Pose& motion, double share) {
  return homogeneous({motion.x * share, motion.y * share, motion.theta * share});
}

// In world axes.
Eigen::Matrix3d world_information(const AbsolutePose& z) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = homogeneous(z.pose).topLeftCorner<2, 2>();
  return R * z.information * R.transpose();
}

// A fix without noise, between the second and the third frame behind a keyframe, has no residual
// at the true keyframe; its information is that of naive propagation with numerical derivatives.
TEST(ReadingCarrier, AFixIsCarriedToTheKeyframeBefore) {
  const auto frames = frames_with_holes();
  const Pose start{4.0, -3.0, 2.9};
  const Eigen::Vector2d lever(0.7, -0.4);
  constexpr double kShare = 0.3;
  const Eigen::Matrix3d M = homogeneous(frames[1].motion.mean) * homogeneous(frames[2].motion.mean);
  const auto antenna = [&](const Pose& keyframe, const Eigen::Matrix3d& motion) {
    const Eigen::Vector3d at =
        homogeneous(keyframe) * motion * Eigen::Vector3d(lever.x(), lever.y(), 1.0);
    return Eigen::Vector2d(at.head<2>());
  };
  const Eigen::Matrix3d whole = M * part(frames[3].motion.mean, kShare);
  Eigen::Matrix2d C;
  C << 0.04, 0.01, 0.01, 0.09;
  AbsoluteReadings readings;
  readings.fixes = {{2'300'000'000, antenna(start, whole), C}};
  readings.lever_m = lever;
  ReadingCarrier carrier(readings, over(frames), start_at(start));
  const auto carried = carrier.of(0, 0, 4);
  ASSERT_EQ(carried.size(), 1u);
  EXPECT_EQ(carried[0].keyframe, 0u);
  EXPECT_LT(residual(carried[0], start).norm(), 1e-12);
  EXPECT_TRUE(carrier.of(1, 4, std::nullopt).empty());

  // The covariance of the motion, composed naively: each part's noise through the rest of the way.
  Eigen::Matrix2d expected = C;
  const auto add_noise = [&](const Eigen::Matrix3d& before, const Pose& mean,
                             const Eigen::Matrix3d& after, const Eigen::Matrix3d& covariance) {
    const Eigen::Matrix3d J = test::numerical_jacobian(
        [&](const Pose& noisy) {
          const Eigen::Vector2d p = antenna(start, before * homogeneous(noisy) * after);
          return Eigen::Vector3d(p.x(), p.y(), 0.0);
        },
        mean);
    expected += (J * covariance * J.transpose()).topLeftCorner<2, 2>();
  };
  const Pose last = Pose::from_vector(kShare * frames[3].motion.mean.vector());
  add_noise(Eigen::Matrix3d::Identity(), frames[1].motion.mean,
            homogeneous(frames[2].motion.mean) * homogeneous(last), frames[1].motion.covariance);
  add_noise(homogeneous(frames[1].motion.mean), frames[2].motion.mean, homogeneous(last),
            frames[2].motion.covariance);
  add_noise(M, last, Eigen::Matrix3d::Identity(), kShare * frames[3].motion.covariance);
  const Eigen::Matrix3d J = test::numerical_jacobian(
      [&](const Pose& keyframe) {
        const Eigen::Vector2d p = antenna(keyframe, whole);
        return Eigen::Vector3d(p.x(), p.y(), 0.0);
      },
      start);
  const Eigen::Matrix<double, 2, 3> H = J.topRows<2>();
  const Eigen::Matrix3d information = H.transpose() * expected.inverse() * H;
  EXPECT_LT((world_information(carried[0]) - information).norm(), 1e-6 * information.norm());
}

TEST(ReadingCarrier, AHeadingTakesTheTurnAndItsVariance) {
  const auto frames = frames_with_holes();
  AbsoluteReadings readings;
  readings.headings = {{1'500'000'000, -3.1, 0.02}};
  ReadingCarrier carrier(readings, over(frames), start_at({}));
  const auto carried = carrier.of(0, 0, 4);
  ASSERT_EQ(carried.size(), 1u);
  // 1.5 motions of 0.3 rad before −3.1, past π.
  EXPECT_NEAR(carried[0].pose.theta, test::angle_between(-3.1 - 0.45, 0.0), 1e-14);
  const double variance =
      0.0004 + frames[1].motion.covariance(2, 2) + 0.5 * frames[2].motion.covariance(2, 2);
  EXPECT_NEAR(carried[0].information(2, 2) * variance, 1.0, 1e-12);
  EXPECT_TRUE((carried[0].information.topLeftCorner<2, 3>().isZero(0.0)));
}

TEST(ReadingCarrier, EachReadingHasItsKeyframeInOrderOfTime) {
  const auto frames = frames_with_holes();
  AbsoluteReadings readings;
  readings.headings = {{-5, 0.1, 0.1},
                       {0, 0.0, 0.1},
                       {2 * kFrame, 0.6, 0.1},
                       {3 * kFrame - 1, 0.9, 0.1},
                       {3 * kFrame, 0.9, 0.1},
                       {6 * kFrame, 1.8, 0.1},
                       {6 * kFrame + 1, 1.8, 0.1}};
  readings.fixes = {{2 * kFrame + 1, {1.0, 0.2}, Eigen::Matrix2d::Identity()}};
  ReadingCarrier carrier(readings, over(frames), start_at({}));
  const auto first = carrier.of(0, 0, 3);
  ASSERT_EQ(first.size(), 4u);
  // The fix stands between the headings: it alone says a position.
  EXPECT_GT(first[2].information(0, 0), 0.0);
  EXPECT_EQ(first[3].information(0, 0), 0.0);
  const auto last = carrier.of(1, 3, std::nullopt);
  ASSERT_EQ(last.size(), 2u);
  for (const AbsolutePose& z : last) EXPECT_EQ(z.keyframe, 1u);
  EXPECT_NEAR(last[0].pose.theta, 0.9, 1e-12);
  EXPECT_NEAR(last[1].pose.theta, 0.9, 1e-12);
}

// Behind a hole the keyframe after is the one that dead reckoning leads to.
TEST(ReadingCarrier, ReadingsBehindAHoleGoToTheKeyframeAfter) {
  const auto frames = frames_with_holes({2});
  AbsoluteReadings readings;
  readings.headings = {
      {500'000'000, 0.15, 0.01}, {2 * kFrame, 0.6, 0.01}, {3'500'000'000, 1.05, 0.01}};
  ReadingCarrier carrier(readings, over(frames), start_at({}));
  const auto before = carrier.of(0, 0, 4);
  ASSERT_EQ(before.size(), 1u);
  EXPECT_NEAR(before[0].pose.theta, 0.0, 1e-14);
  const auto after = carrier.of(1, 4, std::nullopt);
  ASSERT_EQ(after.size(), 2u);
  for (const AbsolutePose& z : after) {
    EXPECT_EQ(z.keyframe, 1u);
    EXPECT_NEAR(z.pose.theta, 1.2, 1e-14);
  }
  const double half = 0.5 * frames[4].motion.covariance(2, 2);
  EXPECT_NEAR(after[1].information(2, 2) * (1e-4 + half), 1.0, 1e-9);
}

// Dead reckoning's heading is off by 0.5 rad from the start on; the compass knows better.
TEST(ReadingCarrier, TheCompassCorrectsTheHeadingOfAFix) {
  const auto frames = frames_with_holes();
  AbsoluteReadings readings;
  readings.headings = {{0, 0.5, 0.001}};
  readings.fixes = {{kFrame, {0.0, 0.0}, Eigen::Matrix2d::Identity()}};
  StartPose start(Pose{});
  start.covariance = Eigen::Matrix3d::Identity();
  ReadingCarrier carrier(readings, over(frames), start);
  EXPECT_NEAR(carrier.of(0, 0, 2).back().pose.theta, 0.5, 1e-5);
}

TEST(ReadingChoice, LeavesOutNeighbours) {
  std::vector<MeasuredHeading> readings;
  for (std::int64_t i = 0; i < 10; ++i) readings.push_back({i * 333'333'333, 0.0, 0.1});
  EXPECT_EQ(chosen(readings, {true, 0.0}).size(), 10u);
  // Thirds of a second, cut to whole nanoseconds.
  EXPECT_EQ(chosen(readings, {true, 1.0}).size(), 4u);
  EXPECT_TRUE(chosen(readings, {false, 0.0}).empty());
}

}  // namespace
}  // namespace fathom
