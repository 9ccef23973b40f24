// The errors of drawn measurements, against their closed forms.

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "datasets/small_log.hpp"

namespace fathom {
namespace {

using test::error_of;
using test::flown;
using test::registrations_of;
using test::sweep;

/// Mean of e eᵀ over the registrations of many trials, and the mean NIS.
struct Errors {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  double nis = 0.0;
  std::size_t count = 0;
};

Errors errors_of(const SimulatedLogOptions& options, std::uint64_t trials) {
  const FlownKeyframes keyframes = flown(options);
  Errors errors;
  for (std::uint64_t trial = 0; trial < trials; ++trial) {
    for (const RelativePose& z : registrations_of(draw_log(keyframes, options, 3, trial))) {
      const Eigen::Vector3d e = error_of(z, keyframes);
      errors.covariance += e * e.transpose();
      errors.nis += e.dot(z.covariance().inverse() * e);
      ++errors.count;
    }
  }
  errors.covariance /= static_cast<double>(errors.count);
  errors.nis /= static_cast<double>(errors.count);
  return errors;
}

void expect_near(const Eigen::Matrix3d& actual, const Eigen::Matrix3d& expected, double share) {
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double scale = std::sqrt(expected(i, i) * expected(j, j));
      EXPECT_NEAR(actual(i, j), expected(i, j), share * scale) << i << ' ' << j;
    }
  }
}

// The step's covariance is that of its error, composed frame by frame with corners between.
TEST(SimulatedLogErrors, StepsHaveTheCovarianceTheyTell) {
  SimulatedLogOptions options = sweep();
  options.odometry.covariance = {4e-4, 1e-4, 5e-5, 2e-4, -2e-5, 4e-4};
  const FlownKeyframes keyframes = flown(options);
  double nis = 0.0;
  std::size_t count = 0;
  for (std::uint64_t trial = 0; trial < 300; ++trial) {
    const MeasurementLog log = draw_log(keyframes, options, 5, trial);
    for (std::size_t k = 1; k < log.size(); ++k) {
      const RelativePose& step = log.arrival(k).step;
      const Eigen::Vector3d e = error_of(step, keyframes);
      nis += e.dot(step.covariance().inverse() * e);
      ++count;
    }
  }
  // A mean of χ²₃ within four of its standard deviations, and 1 % for what is not linear.
  EXPECT_NEAR(nis / static_cast<double>(count), 3.0,
              4.0 * std::sqrt(6.0 / static_cast<double>(count)) + 0.03);
}

TEST(SimulatedLogErrors, RegistrationsHaveTheCovarianceTheyTell) {
  SimulatedLogOptions options = sweep();
  options.loops.noise.covariance = {4e-4, 1e-4, 5e-5, 2e-4, -2e-5, 1e-4};
  const Errors errors = errors_of(options, 800);
  ASSERT_GT(errors.count, 2000U);
  expect_near(errors.covariance, options.loops.noise.noise_covariance(""), 0.06);
  EXPECT_NEAR(errors.nis, 3.0, 4.0 * std::sqrt(6.0 / static_cast<double>(errors.count)));
}

// z of two poses X ⊕ u: its error has R, and both ends' share in the frame of the older keyframe.
TEST(SimulatedLogErrors, SharedErrorsAreThoseOfThePictures) {
  SimulatedLogOptions options = sweep();
  options.loops.shared_sigma_m = 0.02;
  const Errors errors = errors_of(options, 800);
  Eigen::Matrix3d expected = options.loops.noise.noise_covariance("");
  expected.topLeftCorner<2, 2>() += 2.0 * 4e-4 * Eigen::Matrix2d::Identity();
  expect_near(errors.covariance, expected, 0.06);
  // And are the same in all registrations of a keyframe: two to neighbours differ by R alone.
  options.loops.noise.sigma_x_m = options.loops.noise.sigma_y_m = 1e-6;
  options.loops.noise.sigma_theta_rad = 1e-6;
  options.loops.probability = 1.0;
  options.loops.max_distance_m = 1e9;
  const FlownKeyframes keyframes = flown(options);
  const MeasurementLog log = draw_log(keyframes, options, 6, 0);
  const std::size_t last = log.size() - 1;
  for (std::size_t k = 1; k < last; ++k) {
    // 0 to last is 0 to k and on to last: with errors of its own in each it would not close.
    const auto& at_last = log.arrival(last).registrations;
    const Pose by_way = compose(log.arrival(k).registrations[0].motion, at_last[k].motion);
    EXPECT_NEAR(by_way.x, at_last[0].motion.x, 1e-3);
    EXPECT_NEAR(by_way.y, at_last[0].motion.y, 1e-3);
  }
}

TEST(SimulatedLogErrors, ScaleAndTails) {
  SimulatedLogOptions options = sweep();
  options.loops.scale_error = 0.1;
  options.loops.noise.sigma_x_m = options.loops.noise.sigma_y_m = 1e-6;
  const FlownKeyframes keyframes = flown(options);
  for (const RelativePose& z : registrations_of(draw_log(keyframes, options, 1, 0))) {
    const Pose truth = between(keyframes[z.from].pose, keyframes[z.to].pose);
    EXPECT_NEAR(z.motion.x, 1.1 * truth.x, 1e-5);
    EXPECT_NEAR(z.motion.y, 1.1 * truth.y, 1e-5);
  }
  // A mixture of N(0, R) and N(0, 25 R): the mean NIS is 3 (0.9 + 0.1 · 25).
  options = sweep();
  options.loops.tail_share = 0.1;
  options.loops.tail_factor = 5.0;
  EXPECT_NEAR(errors_of(options, 800).nis, 3.0 * 3.4, 0.5);
}

}  // namespace
}  // namespace fathom
