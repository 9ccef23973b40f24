// Absolute measurements and an uncertain start, where an estimator's method says more than the
// contract does.

#include <gtest/gtest.h>

#include "src/harness/conformance/naive_least_squares.hpp"
#include "src/harness/conformance/world_logs.hpp"
#include "tests/estimators/cross_estimator.hpp"

namespace fathom::test {
namespace {

// Without absolute measurements a start's uncertainty moves nothing, and comes on top: a turn of
// the whole map about keyframe 0, and a shift. Not so in the EKF on poses, which learns from loops
// what they do not say of the map's heading: its Jacobians are of different estimates
// (docs/absolute_measurements.md). first_estimates_ekf learns nothing, but what it says of a turn
// is about the first estimates.
TEST(CrossEstimator, AnUncertainStartCarriesOverToEveryKeyframeOfANoisyLog) {
  const MeasurementLog plain = circle_log({.origin = {1.0, 2.0, -3.0}});
  MeasurementLog log = plain;
  log.set_start(uncertain_start(plain.origin(), 0.3, 0.05));
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    if (entry.name == "ekf" || entry.name == "first_estimates_ekf") continue;
    const auto fixed = solved(entry.name, plain, exactly());
    const auto free = solved(entry.name, log, exactly());
    EXPECT_LT(largest_distance(poses_of(*free), poses_of(*fixed)), 1e-9) << entry.name;
    for (std::size_t k = 0; k < log.size(); ++k) {
      Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
      const Eigen::Vector2d lever = fixed->pose(k).position() - fixed->pose(0).position();
      J.topRightCorner<2, 1>() << -lever.y(), lever.x();
      const Eigen::Matrix3d expected = *fixed->covariance(k) + transport(J, log.start().covariance);
      EXPECT_LT((*free->covariance(k) - expected).norm(), 1e-7 * expected.norm())
          << entry.name << " " << k;
    }
  }
}

// Filters linearise once a keyframe and are only near it.
TEST(CrossEstimator, WithAbsoluteMeasurementsEveryGraphIsThatOfLeastSquares) {
  WorldOptions options;
  options.start = uncertain_start({2.0, -1.0, 3.1}, 0.2, 0.03);
  options.pose_every = 13;
  const MeasurementLog log = circle_in_world(options);
  const NaiveLeastSquares expected = least_squares(log, 10);
  const std::vector<std::size_t> some{0, 7, 3, 39};
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    if (entry.name.ends_with("ekf")) continue;
    const auto estimator = solved(entry.name, log, exactly());
    EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-7) << entry.name;
    for (std::size_t k = 0; k < log.size(); ++k) {
      const Eigen::Matrix3d C = expected.marginal(k);
      EXPECT_LT((*estimator->covariance(k) - C).norm(), 1e-4 * C.norm()) << entry.name << " " << k;
    }
    EXPECT_LT(largest_block_difference(*estimator->joint_covariance(some), expected.joint(some)),
              1e-4)
        << entry.name;
  }
}

}  // namespace
}  // namespace fathom::test
