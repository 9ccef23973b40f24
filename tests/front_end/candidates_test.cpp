#include "fathom/front_end/candidates.hpp"

#include <cmath>
#include <limits>

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"

namespace fathom {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

/// An estimate made by hand. `sigma_m` of a keyframe: of its motion to the newest, in x and y.
class Estimate : public TrajectoryView {
 public:
  explicit Estimate(std::vector<Pose> poses, std::vector<double> sigma_m = {})
      : poses_(std::move(poses)), sigma_m_(std::move(sigma_m)) {}

  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override {
    if (sigma_m_.empty()) return std::nullopt;
    std::vector<UncertainPose> motions;
    for (std::size_t k = 0; k < sigma_m_.size(); ++k) {
      const double variance = sigma_m_[k] * sigma_m_[k];
      motions.push_back({between(poses_[k], poses_.back()),
                         Eigen::Vector3d(variance, variance, 0.01).asDiagonal()});
    }
    return motions;
  }

 private:
  std::vector<Pose> poses_;
  std::vector<double> sigma_m_;
};

// A picture covers 2 m along x and 3 m along y from 1 m up: 300 × 200 pixels, focal length 100.
Camera wide_camera() {
  CameraModel model;
  model.width = 300;
  model.height = 200;
  model.fx = model.fy = 100.0;
  model.cx = 149.5;
  model.cy = 99.5;
  return Camera(model);
}

constexpr CandidateMethod kMethods[] = {CandidateMethod::distance, CandidateMethod::mahalanobis,
                                        CandidateMethod::overlap,
                                        CandidateMethod::possible_overlap};

CandidateOptions by(CandidateMethod method) {
  CandidateOptions options;
  options.method = method;
  options.max_distance_m = 3.0;
  return options;
}

Candidates candidates(const CandidateOptions& options, const TrajectoryView& estimate,
                      std::vector<double> altitudes_m = {}) {
  altitudes_m.resize(estimate.size(), 1.0);
  return CandidateSearch(wide_camera(), options).find(estimate, altitudes_m, estimate.size() - 1);
}

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

// Pictures of 2 m × 3 m that lie alike reach 0.9 · 3 m. The first is 5 m off: 2.3 m beyond, which
// 3.035 sigmas of 0.758 m cover and of 0.757 m do not. Between reach and overlap, 2.1 m ahead, no
// uncertainty is needed.
TEST(Candidates, ByPossibleOverlapAreThoseThatMaySeeTheSameFloor) {
  CandidateOptions options = by(CandidateMethod::possible_overlap);
  const auto found = [&](double sigma_m) {
    const Estimate estimate({{-5, 0, 0}, {0, 9, 0}, {0, -1.4, 0}, {2.1, 0, 0}, {0, 0, 0}},
                            {sigma_m, 1e-9, 1e-9, 1e-9});
    return candidates(options, estimate).keyframes;
  };
  EXPECT_THAT(found(0.757), ElementsAre(2, 3));
  EXPECT_THAT(found(0.758), ElementsAre(0, 2, 3));
  options.min_overlap = 0.5;  // reach 1.5 m: 3.5 m are left, 3.035 sigmas of 1.154 m
  EXPECT_THAT(found(1.153), ElementsAre(2));
  EXPECT_THAT(found(1.154), ElementsAre(0, 2));
}

TEST(Candidates, ByPossibleOverlapScaleWithTheAltitude) {
  CandidateOptions options = by(CandidateMethod::possible_overlap);
  RandomStream random(8, "altitude");
  std::vector<Pose> poses;
  for (int k = 0; k < 60; ++k) {
    poses.push_back({random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)});
  }
  const auto at = [&](double scale) {
    std::vector<Pose> scaled = poses;
    for (Pose& pose : scaled) pose = {scale * pose.x, scale * pose.y, pose.theta};
    return candidates(options, Estimate(scaled, std::vector<double>(59, 0.4 * scale)),
                      std::vector<double>(60, scale))
        .keyframes;
  };
  EXPECT_GT(at(1.0).size(), 5u);
  for (const double scale : {0.25, 4.0, 16.0}) EXPECT_EQ(at(scale), at(1.0));
}

// Keyframes 0 to 2 and 5 to 7 passed by here, 3 and 4 did not. The best of either pass come first,
// then the second best.
TEST(Candidates, OfPossibleOverlapsTheBudgetTakesTheBestOfEachPass) {
  CandidateOptions options = by(CandidateMethod::possible_overlap);
  const Estimate estimate({{-1.3, 1, 0},
                           {-0.5, 1, 0},
                           {0.7, 1, 0},
                           {20, 0, 0},
                           {30, 0, 0},
                           {-1.2, 0, 0},
                           {-0.8, 0, 0},
                           {-0.4, 0, 0},
                           {0, 0, 0}},
                          std::vector<double>(8, 1e-9));
  const auto best = [&](int count) {
    options.budget = count;
    const Candidates found = candidates(options, estimate);
    EXPECT_EQ(found.keyframes.size() + found.left_out, 6u);
    return found.keyframes;
  };
  EXPECT_THAT(best(1), ElementsAre(7));
  EXPECT_THAT(best(2), ElementsAre(1, 7));
  EXPECT_THAT(best(3), ElementsAre(1, 6, 7));
  EXPECT_THAT(best(4), ElementsAre(1, 2, 6, 7));
  EXPECT_THAT(best(6), ElementsAre(0, 1, 2, 5, 6, 7));
}

TEST(Candidates, AutomaticGoesByWhatIsGiven) {
  CandidateOptions options;
  EXPECT_EQ(options.method_in_force(), CandidateMethod::possible_overlap);
  EXPECT_TRUE(options.asks_covariances());
  options.max_distance_m = 2.0;
  EXPECT_EQ(options.method_in_force(), CandidateMethod::distance);
  EXPECT_FALSE(options.asks_covariances());
}

TEST(Candidates, ByDistanceNeedOne) {
  for (const CandidateMethod method : {CandidateMethod::distance, CandidateMethod::mahalanobis}) {
    CandidateOptions options;
    options.method = method;
    EXPECT_THROW(CandidateSearch(wide_camera(), options), InputError);
  }
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

}  // namespace
}  // namespace fathom
