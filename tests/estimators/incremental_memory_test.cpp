// A smoother that keeps hardly any Schur complement is the same smoother.

#include <gtest/gtest.h>

#include "estimators/incremental_smoother/smoother.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/estimators/smoother_logs.hpp"

namespace fathom {
namespace {

using incremental_smoother::Smoother;
using incremental_smoother::SmootherLimits;

SmootherLimits exact_limits() {
  SmootherLimits limits;
  limits.tolerance = 1e-13;
  return limits;
}

Outcome arrive(Smoother& smoother, const MeasurementLog& log, std::size_t k) {
  smoother.add_keyframe(log.arrival(k).step);
  if (log.arrival(k).registrations.empty()) return Outcome::converged;
  return smoother.add_registrations(log.arrival(k).registrations).outcome;
}

std::vector<Pose> all_poses(Smoother& smoother) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < smoother.size(); ++k) poses.push_back(smoother.pose(k));
  return poses;
}

TEST(IncrementalMemory, WhatIsDroppedIsMadeAgain) {
  for (const MeasurementLog& log :
       {test::tracks_log(900, 30), test::wandering_log(300, 2), test::wandering_log(400, 5)}) {
    SmootherLimits little = exact_limits();
    little.most_kept_bytes = 0;
    Smoother keeps(log.origin(), exact_limits());
    Smoother drops(log.origin(), little);
    for (std::size_t k = 1; k < log.size(); ++k) {
      ASSERT_EQ(arrive(keeps, log, k), Outcome::converged) << k;
      ASSERT_EQ(arrive(drops, log, k), Outcome::converged) << k;
      if (k % 10 != 0) continue;
      ASSERT_LT(test::largest_distance(all_poses(keeps), all_poses(drops)), 1e-5) << k;
      ASSERT_LT(test::largest_turn(all_poses(keeps), all_poses(drops)), 1e-5) << k;
    }
    EXPECT_GT(drops.counts().eliminated, keeps.counts().eliminated);
  }
}

// Along tracks what an update needs is what the one before needed.
TEST(IncrementalMemory, ASurveyEliminatesLittleMore) {
  const MeasurementLog log = test::tracks_log(3000, 30);
  SmootherLimits little;
  little.most_kept_bytes = 0;
  Smoother keeps(log.origin(), {});
  Smoother drops(log.origin(), little);
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(keeps, log, k);
    arrive(drops, log, k);
  }
  EXPECT_GT(drops.counts().eliminated, keeps.counts().eliminated);
  EXPECT_LT(drops.counts().eliminated, 2 * keeps.counts().eliminated);
}

// To a part that was not looked at for long: of the map some Schur complements last.
TEST(IncrementalMemory, ALongLoopEliminatesAPartOfTheMap) {
  const MeasurementLog log = test::tracks_log(12000, 30);
  SmootherLimits little;
  little.most_kept_bytes = std::size_t{1} << 20U;
  Smoother smoother(log.origin(), little);
  for (std::size_t k = 1; k < log.size(); ++k) arrive(smoother, log, k);
  const std::size_t last = log.size() - 1;
  const RelativePose back =
      RelativePose::from_covariance(100, last, between(smoother.pose(100), smoother.pose(last)),
                                    test::full_covariance(0.03, 0.01));
  const long before = smoother.counts().eliminated;
  EXPECT_EQ(smoother.add_registrations(std::vector{back}).outcome, Outcome::converged);
  EXPECT_LT(smoother.counts().eliminated - before, 4000);
}

TEST(IncrementalMemory, AFailedUpdateLeavesNothing) {
  const MeasurementLog log = test::wandering_log(200, 9);
  SmootherLimits little = exact_limits();
  little.most_kept_bytes = 0;
  Smoother keeps(log.origin(), exact_limits());
  Smoother drops(log.origin(), little);
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(keeps, log, k);
    arrive(drops, log, k);
    if (k % 15 != 0) continue;
    const std::vector<RelativePose> far{{2, k, {1e200, 0.0, 0.0}, Eigen::Matrix3d::Identity(), {}}};
    EXPECT_EQ(drops.add_registrations(far).outcome, Outcome::numerical_failure);
  }
  EXPECT_LT(test::largest_distance(all_poses(keeps), all_poses(drops)), 1e-6);
}

}  // namespace
}  // namespace fathom
