// Which of two motions with enough inliers RANSAC keeps.

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fathom/vision/ransac.hpp"
#include "vision/matched_points.hpp"

namespace fathom {
namespace {

using test::add_true;
using test::kTruth;
using test::Pairs;

TEST(RansacScore, PaperScoreFavoursTheSmallSet) {
  RandomStream random(40);
  Pairs pairs;
  const Pose other{-3.0, 1.0, -0.4};
  add_true(pairs, random, kTruth, 60, 0.008);
  add_true(pairs, random, other, 20, 0.0001);
  RansacOptions options{.max_error_m = 0.03};
  const Consensus most = pairs.found(options);
  ASSERT_TRUE(most.motion.has_value());
  EXPECT_NEAR(most.motion->x, kTruth.x, 0.01);
  options.score = RansacScore::paper;
  const Consensus least = pairs.found(options);
  ASSERT_TRUE(least.motion.has_value());
  EXPECT_NEAR(least.motion->x, other.x, 0.01);
  EXPECT_EQ(least.inliers.size(), 20U);
}

// `count` matches on a circle, each off by the same in or out, which leaves their fit at z.
void add_circle(Pairs& pairs, const Pose& z, int count, double error_m) {
  for (int i = 0; i < count; ++i) {
    const double turn = 2.0 * std::numbers::pi * i / count;
    const Eigen::Vector2d outward =
        rotation(z.theta) * Eigen::Vector2d(std::cos(turn), std::sin(turn));
    pairs.add(z, {std::cos(turn), std::sin(turn)}, (i % 2 == 0 ? error_m : -error_m) * outward);
  }
}

TEST(RansacScore, PaperScoreIsTheSumOfSquares) {
  // Errors sum to 20 and 18.2 units, their squares to 20 and 23.7.
  Pairs pairs;
  add_circle(pairs, kTruth, 20, 1e-4);
  add_circle(pairs, {-3.0, 1.0, -0.4}, 14, 1.3e-4);
  RansacOptions options{.max_error_m = 0.03};
  options.score = RansacScore::paper;
  const Consensus found = pairs.found(options);
  ASSERT_TRUE(found.motion.has_value());
  EXPECT_EQ(found.inliers.size(), 20U);
  EXPECT_NEAR(found.motion->x, kTruth.x, 1e-9);
}

TEST(RansacScore, OfEquallyLargeSetsTheTighterIsKept) {
  RandomStream random(41);
  Pairs pairs;
  const Pose other{-3.0, 1.0, -0.4};
  add_true(pairs, random, kTruth, 30, 0.004);
  add_true(pairs, random, other, 30, 0.001);
  const Consensus found = pairs.found({.max_error_m = 0.03});
  ASSERT_TRUE(found.motion.has_value());
  ASSERT_EQ(found.inliers.size(), 30U);
  EXPECT_NEAR(found.motion->x, other.x, 0.01);
}

}  // namespace
}  // namespace fathom
