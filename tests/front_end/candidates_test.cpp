#include "fathom/front_end/candidates.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "front_end/estimate.hpp"

namespace fathom {
namespace {

using test::by;
using test::candidates;
using test::Estimate;
using test::kMethods;
using test::wide_camera;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(SquaredDistanceToDisc, OfARoundUncertaintyIsTheGapInSigmas) {
  const Eigen::Matrix2d S = 0.25 * Eigen::Matrix2d::Identity();
  EXPECT_EQ(squared_distance_to_disc({0.6, 0.8}, S, 1.0), 0.0);
  EXPECT_NEAR(squared_distance_to_disc({3.0, 4.0}, S, 1.0), 64.0, 1e-9);
  EXPECT_NEAR(squared_distance_to_disc({-3.0, 4.0}, S, 0.0), 100.0, 1e-9);
}

TEST(SquaredDistanceToDisc, IsTheLeastOverTheDisc) {
  RandomStream random(3, "disc");
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Matrix2d A;
    A << random.normal(), random.normal(), random.normal(), random.normal();
    const Eigen::Matrix2d S = A * A.transpose() + 1e-3 * Eigen::Matrix2d::Identity();
    const Eigen::Vector2d d{random.uniform(-5, 5), random.uniform(-5, 5)};
    const double radius_m = random.uniform(0.1, 3.0);
    if (d.norm() <= radius_m) continue;
    // From outside the least is on the circle.
    double least = std::numeric_limits<double>::infinity();
    constexpr int kPoints = 200'000;
    for (int i = 0; i < kPoints; ++i) {
      const double angle = 2.0 * M_PI * i / kPoints;
      const Eigen::Vector2d gap = d - radius_m * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      least = std::min(least, gap.dot(S.inverse() * gap));
    }
    EXPECT_NEAR(squared_distance_to_disc(d, S, radius_m), least, 1e-5 * (1.0 + least));
  }
}

TEST(SquaredDistanceToDisc, WithoutUncertaintyThereIsNoWay) {
  const Eigen::Matrix2d none = Eigen::Matrix2d::Zero();
  const Eigen::Matrix2d along_x = Eigen::Vector2d(1.0, 0.0).asDiagonal();
  EXPECT_TRUE(std::isinf(squared_distance_to_disc({2.0, 0.0}, none, 1.0)));
  EXPECT_TRUE(std::isinf(squared_distance_to_disc({0.0, 2.0}, along_x, 1.0)));
  EXPECT_NEAR(squared_distance_to_disc({3.0, 0.6}, along_x, 1.0), 2.2 * 2.2, 1e-6);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(std::isinf(squared_distance_to_disc({nan, 0.0}, along_x, 1.0)));
}

TEST(Candidates, ByDistanceAreThoseNear) {
  CandidateOptions options = by(CandidateMethod::distance);
  options.max_distance_m = 5.0;
  const Estimate estimate({{0, 0, 0}, {30, 40, 1}, {2, 1, -3}, {3, 4, 1}}, {100, 100, 100});
  EXPECT_THAT(candidates(options, estimate).keyframes, ElementsAre(0, 2));
}

// The newest is 10 m from each, 6 m beyond reach. The 0.99 quantile of χ² with two degrees of
// freedom is −2 ln 0.01 = 3.035², so a sigma of 6 / 3.035 = 1.977 m is the least that will do.
TEST(Candidates, ByMahalanobisAreThoseThatMayBeNear) {
  CandidateOptions options = by(CandidateMethod::mahalanobis);
  options.max_distance_m = 4.0;
  const Estimate estimate({{-10, 0, 0}, {0, 10, 2}, {0, -3, 0}, {10, 0, -1}, {0, 0, 0.5}},
                          {1.97, 1.98, 1e-9, 1e3});
  EXPECT_THAT(candidates(options, estimate).keyframes, ElementsAre(1, 2, 3));
  options.probability = 0.9;  // −2 ln 0.1 = 2.146²: 2.796 m
  EXPECT_THAT(candidates(options, estimate).keyframes, ElementsAre(2, 3));
}

TEST(Candidates, ByMahalanobisOfAnEstimateWithoutCovariancesAreThoseNear) {
  CandidateOptions options = by(CandidateMethod::mahalanobis);
  options.max_distance_m = 4.0;
  const Estimate estimate({{-10, 0, 0}, {0, -3, 0}, {0, 0, 0.5}});
  EXPECT_THAT(candidates(options, estimate).keyframes, ElementsAre(1));
}

TEST(Candidates, ByOverlapAreThoseThatSeeTheSameFloor) {
  CandidateOptions options = by(CandidateMethod::overlap);
  // Overlaps of 2 m × 3 m: 1.5 m ahead leaves 0.25, 1.5 m abeam 0.5, turned by 90° at one place
  // 2 m × 2 m, ⅔; 2.1 m ahead none.
  const Estimate estimate({{-1.5, 0, 0}, {0, 1.5, 0}, {0, 0, M_PI / 2}, {2.1, 0, 0}, {0, 0, 0}});
  options.min_overlap = 0.24;
  EXPECT_THAT(candidates(options, estimate).keyframes, ElementsAre(0, 1, 2));
  options.min_overlap = 0.26;
  EXPECT_THAT(candidates(options, estimate).keyframes, ElementsAre(1, 2));
  options.min_overlap = 0.51;
  EXPECT_THAT(candidates(options, estimate).keyframes, ElementsAre(2));
  // From 2 m up keyframe 3 sees twice as far: 0.9 m of the newest's 2 m.
  options.min_overlap = 0.44;
  EXPECT_THAT(candidates(options, estimate, {1, 1, 1, 2}).keyframes, ElementsAre(1, 2, 3));
}

TEST(Candidates, BeyondTheBudgetTheBestAreKept) {
  CandidateOptions options = by(CandidateMethod::distance);
  options.max_distance_m = 100.0;
  // Overlaps of 0.25, 0.75, none, 0.75 again, none nearer by, and all of it.
  const Estimate estimate(
      {{-1.5, 0, 0}, {0.5, 0, 0}, {9, 0, 0}, {-0.5, 0, 0}, {8, 0, 0}, {0, 0, 0}, {0, 0, 0}});
  const auto best = [&](int count) {
    options.max_per_keyframe = count;
    const Candidates found = candidates(options, estimate);
    EXPECT_EQ(found.keyframes.size() + found.left_out, 6u);
    return found.keyframes;
  };
  EXPECT_THAT(best(1), ElementsAre(5));
  EXPECT_THAT(best(2), ElementsAre(1, 5));  // of two alike the earlier
  EXPECT_THAT(best(3), ElementsAre(1, 3, 5));
  EXPECT_THAT(best(4), ElementsAre(0, 1, 3, 5));
  EXPECT_THAT(best(5), ElementsAre(0, 1, 3, 4, 5));
  EXPECT_THAT(best(6), ElementsAre(0, 1, 2, 3, 4, 5));
  EXPECT_THAT(best(7), ElementsAre(0, 1, 2, 3, 4, 5));
}

TEST(Candidates, AreTheSameForTheSameEstimate) {
  RandomStream random(5, "estimate");
  std::vector<Pose> poses;
  for (int k = 0; k < 300; ++k) {
    poses.push_back({random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)});
  }
  const Estimate estimate(poses, std::vector<double>(299, 1.0));
  for (const CandidateMethod method : kMethods) {
    CandidateOptions options = by(method);
    options.max_per_keyframe = 5;
    options.budget = 5;
    const Candidates first = candidates(options, estimate);
    EXPECT_EQ(first.keyframes.size(), 5u);
    EXPECT_EQ(candidates(options, estimate).keyframes, first.keyframes);
  }
}

TEST(Candidates, OfTheFirstKeyframeAreNone) {
  for (const CandidateMethod method : kMethods) {
    EXPECT_THAT(candidates(by(method), Estimate({{1, 2, 3}})).keyframes, IsEmpty());
  }
}

TEST(Candidates, AStepIsJudgedAsAPairOfKeyframesIs) {
  CandidateOptions options = by(CandidateMethod::distance);
  options.max_distance_m = 2.0;
  EXPECT_TRUE(CandidateSearch(wide_camera(), options).accepts({2, 0, 0}, 1.0, 1.0));
  EXPECT_FALSE(CandidateSearch(wide_camera(), options).accepts({2, 0.1, 0}, 1.0, 1.0));
  options = by(CandidateMethod::overlap);
  EXPECT_TRUE(CandidateSearch(wide_camera(), options).accepts({1.7, 0, 0}, 1.0, 1.0));
  EXPECT_FALSE(CandidateSearch(wide_camera(), options).accepts({1.9, 0, 0}, 1.0, 1.0));
}

// By the footprints themselves: no shortcut loses a picture that a tilt lets see far.
TEST(Candidates, OfTiltedPicturesAreThoseThatOverlap) {
  CandidateOptions options;
  options.method = CandidateMethod::overlap;
  options.min_overlap = 0.05;
  RandomStream random(5, "tilted_candidates");
  std::vector<Pose> poses;
  std::vector<Stance> stances;
  std::size_t found = 0;
  for (std::size_t n = 0; n < 60; ++n) {
    poses.push_back({random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-3, 3)});
    stances.emplace_back(random.uniform(0.8, 1.2),
                         Tilt{random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)});
    std::vector<std::size_t> expected;
    for (std::size_t k = 0; k < n; ++k) {
      const Pose motion = between(poses[k], poses[n]);
      const double overlap = footprint_overlap(wide_camera(), stances[k], stances[n], motion);
      if (overlap >= options.min_overlap) expected.push_back(k);
    }
    EXPECT_EQ(candidates(options, Estimate(poses), stances).keyframes, expected) << n;
    found += expected.size();
  }
  EXPECT_GT(found, 100u);
}

}  // namespace
}  // namespace fathom
