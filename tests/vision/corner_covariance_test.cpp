// Inliers that crowd in a corner of the overlap.

#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/vision/registration.hpp"
#include "vision/labelled.hpp"

namespace fathom {
namespace {

using test::kTrueMotion;

// NIS and the standard deviation of the heading, over draws of `count` inliers in a square.
struct Scatter {
  double nis = 0.0;
  double sigma_rad = 0.0;
  double sigma_m = 0.0;
};

Scatter scatter_of(double side_m) {
  constexpr int kTrials = 300;
  Scatter mean;
  for (int trial = 0; trial < kTrials; ++trial) {
    RandomStream random(10, "corner", static_cast<std::uint64_t>(trial));
    std::vector<Eigen::Vector2d> p;
    std::vector<Eigen::Vector2d> q;
    for (int i = 0; i < 120; ++i) {
      const double x = random.uniform(1.3 - side_m, 1.3);
      q.emplace_back(x, random.uniform(1.0 - side_m, 1.0));
      const double dx = 0.004 * random.normal();
      const double dy = 0.004 * random.normal();
      p.push_back(transform(kTrueMotion, q.back()) + Eigen::Vector2d(dx, dy));
    }
    RegistrationOptions options;
    options.covariance.tilt_sigma_rad = 0.0;
    options.decision.method = DecisionOptions::Method::inliers;
    options.ransac.iterations = 100;
    const Registration result = register_pair(test::labelled(p), test::labelled(q), options,
                                              static_cast<std::uint64_t>(trial));
    if (!result.found) return {};
    const Eigen::Vector3d nu(result.motion.x - kTrueMotion.x, result.motion.y - kTrueMotion.y,
                             wrap_angle(result.motion.theta - kTrueMotion.theta));
    mean.nis += nu.dot(result.covariance.ldlt().solve(nu)) / kTrials;
    mean.sigma_rad += std::sqrt(result.covariance(2, 2)) / kTrials;
    mean.sigma_m += std::sqrt(result.covariance(0, 0)) / kTrials;
  }
  return mean;
}

TEST(Covariance, OfInliersInACornerIsLargerAndAsHonest) {
  const Scatter spread = scatter_of(2.0);
  const Scatter corner = scatter_of(0.5);
  // A quarter of the side is four times the σ of the heading.
  EXPECT_NEAR(corner.sigma_rad / spread.sigma_rad, 4.0, 0.5);
  EXPECT_GT(corner.sigma_m, 2.0 * spread.sigma_m);
  // These errors are independent, but 0.055² of one is taken for shared, beside 1/120 of the mean
  // of 120: x and y count as 1.36 times as uncertain, so that 1 + 2/1.36 = 2.47 is expected, and a
  // few per cent less as clustering counts as none where it seems below one. 99.9 % of the means of
  // 300 lie within 3.29 √(6/300) = 0.47.
  EXPECT_NEAR(spread.nis, 2.42, 0.47);
  EXPECT_NEAR(corner.nis, 2.42, 0.47);
}

}  // namespace
}  // namespace fathom
