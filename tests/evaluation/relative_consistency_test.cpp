#include "fathom/evaluation/relative_consistency.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/evaluation/consistency.hpp"
#include "fathom/geometry/covariance.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::random_covariance;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(KeyframePairs, AreAllOfASeparation) {
  EXPECT_THAT(pairs_over_keyframes(5, 3), ElementsAre(KeyframePair{0, 3}, KeyframePair{1, 4}));
  EXPECT_THAT(pairs_over_keyframes(3, 3), IsEmpty());
}

TEST(KeyframePairs, OverADistanceTakeTheFirstThatReachesIt) {
  // Path lengths 0, 1, 2.5, 3; the way back counts as way.
  const std::vector<Pose> path{{0, 0, 0}, {1, 0, 0}, {1, 1.5, 2}, {1, 1, 2}};
  EXPECT_THAT(pairs_over_distance(path, 1.4), ElementsAre(KeyframePair{0, 2}, KeyframePair{1, 2}));
  EXPECT_THAT(pairs_over_distance(path, 3.1), IsEmpty());
}

// Four steps of 1.25 m are 5 m, whatever the last bit of their sum.
TEST(KeyframePairs, OverADistanceRoundingDoesNotDecide) {
  std::vector<Pose> path;
  for (int k = 0; k < 60; ++k) {
    const double way_m = 1.25 * k;
    path.push_back({way_m * std::cos(0.3), way_m * std::sin(0.3), 0.3});
  }
  for (const KeyframePair& pair : pairs_over_distance(path, 5.0)) {
    EXPECT_EQ(pair.to - pair.from, 4u) << pair.from;
  }
}

TEST(KeyframePairs, AnchorsStandInTheMiddleOfEqualParts) {
  EXPECT_THAT(pairs_with_anchors(10, 2, 3),
              ElementsAre(KeyframePair{2, 0}, KeyframePair{2, 5}, KeyframePair{2, 9},
                          KeyframePair{7, 0}, KeyframePair{7, 5}, KeyframePair{7, 9}));
  EXPECT_THAT(pairs_with_anchors(2, 5, 9), ElementsAre(KeyframePair{0, 1}, KeyframePair{1, 0}));
  EXPECT_THAT(pairs_with_anchors(1, 5, 9), IsEmpty());
}

TEST(KeyframePairs, ThinnedOnesReachFromEndToEnd) {
  const auto all = pairs_over_keyframes(101, 1);
  EXPECT_THAT(thinned(all, 3),
              ElementsAre(KeyframePair{0, 1}, KeyframePair{50, 51}, KeyframePair{99, 100}));
  EXPECT_EQ(thinned(all, 100), all);
  EXPECT_EQ(thinned(all, 500), all);
  EXPECT_THAT(thinned(all, 1), ElementsAre(KeyframePair{0, 1}));
  EXPECT_THAT(thinned({}, 4), IsEmpty());
}

TEST(MotionsToJudge, AreThoseThatTheReferenceHas) {
  std::vector<Pose> path;
  for (int k = 0; k < 30; ++k) path.push_back({0.5 * k, 0, 0});
  const auto groups = motions_to_judge(
      path,
      {.rpe_keyframes = {1, 40}, .rpe_distances_m = {2, 50}, .anchors = 3, .relative_pairs = 7});
  ASSERT_EQ(groups.size(), 3u);
  EXPECT_EQ(groups[0].over, MotionsOver::keyframes);
  EXPECT_EQ(groups[1].over, MotionsOver::distance_m);
  EXPECT_EQ(groups[1].amount, 2.0);
  EXPECT_EQ(groups[1].pairs.size(), 7u);
  EXPECT_EQ(groups[1].pairs[0], (KeyframePair{0, 4}));
  EXPECT_EQ(groups[2].over, MotionsOver::anchors);
}

// An estimate by dead reckoning along a path that turns through ±π, its steps drawn from full
// covariances.
struct Chain {
  std::vector<Pose> truth{{1.0, -2.0, 2.9}};
  std::vector<Pose> estimate{{1.0, -2.0, 2.9}};
  std::vector<Eigen::Matrix3d> steps;  ///< covariances

  Chain(std::size_t keyframes, std::uint64_t seed) {
    RandomStream random(seed, "chain");
    RandomStream shapes(7, "covariances");
    for (std::size_t k = 1; k < keyframes; ++k) {
      const Pose motion{0.5, 0.1, k % 2 == 0 ? 0.4 : -0.1};
      steps.push_back(random_covariance(shapes, 1e-3));
      const Eigen::Matrix3d L = steps.back().llt().matrixL();
      const Eigen::Vector3d draw(random.normal(), random.normal(), random.normal());
      truth.push_back(compose(truth.back(), motion));
      estimate.push_back(compose(estimate.back(), Pose::from_vector(motion.vector() + L * draw)));
    }
  }

  // Of ⊖X_i ⊕ X_k, a sum over the steps between: each turned, its heading with the lever from its
  // end to k. The way back has the sign of the whole, which a square does not see.
  Eigen::Matrix3d covariance(const KeyframePair& pair) const {
    const Pose& from = estimate[pair.from];
    const Pose& to = estimate[pair.to];
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (std::size_t k = std::min(pair.from, pair.to); k < std::max(pair.from, pair.to); ++k) {
      const Eigen::Vector2d lever =
          rotation(-from.theta) * (to.position() - estimate[k + 1].position());
      Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
      J.topLeftCorner<2, 2>() = rotation(estimate[k].theta - from.theta);
      J(0, 2) = -lever.y();
      J(1, 2) = lever.x();
      sum += J * steps[k] * J.transpose();
    }
    return sum;
  }
};

JudgedMotions judged(const Chain& chain, JudgedMotions motions) {
  for (const KeyframePair& pair : motions.pairs) {
    motions.covariances.push_back(chain.covariance(pair));
  }
  return motions;
}

const MetricOptions kOptions{
    .rpe_keyframes = {1, 5}, .rpe_distances_m = {4}, .anchors = 4, .relative_pairs = 10};

// 1 for every kind of motions, within five standard errors of the mean over the draws.
TEST(RelativeAnees, IsOneOfErrorsThatAreAsStated) {
  constexpr int kDraws = 400;
  std::vector<std::vector<double>> values(4);
  for (int draw = 0; draw < kDraws; ++draw) {
    const Chain chain(25, static_cast<std::uint64_t>(draw));
    const auto groups = motions_to_judge(chain.truth, kOptions);
    ASSERT_EQ(groups.size(), values.size());
    for (std::size_t g = 0; g < groups.size(); ++g) {
      const auto anees = relative_anees(chain.estimate, chain.truth, judged(chain, groups[g]));
      ASSERT_TRUE(anees);
      values[g].push_back(*anees);
    }
  }
  for (const auto& of_group : values) {
    const Eigen::Map<const Eigen::ArrayXd> all(of_group.data(), kDraws);
    const double variance = (all - all.mean()).square().sum() / (kDraws - 1.0);
    EXPECT_NEAR(all.mean(), 1.0, 5.0 * std::sqrt(variance / kDraws));
    EXPECT_LT(std::sqrt(variance / kDraws), 0.04);
  }
}

TEST(RelativeAnees, DoesNotDependOnTheWorldOfEither) {
  const Chain chain(25, 3);
  for (const JudgedMotions& plain : motions_to_judge(chain.truth, kOptions)) {
    const JudgedMotions motions = judged(chain, plain);
    const double expected = relative_anees(chain.estimate, chain.truth, motions).value();
    std::vector<Pose> estimate;
    std::vector<Pose> truth;
    for (const Pose& pose : chain.estimate) estimate.push_back(compose(Pose{4, 5, 2.0}, pose));
    for (const Pose& pose : chain.truth) truth.push_back(compose(Pose{-9, 1, -1.1}, pose));
    EXPECT_NEAR(relative_anees(estimate, truth, motions).value(), expected, 1e-6 * expected);
  }
}

// A heading error of 0.2 rad across ±π, by hand.
TEST(RelativeAnees, WrapsHeadings) {
  const double pi = std::numbers::pi;
  const std::vector<Pose> estimate{{0, 0, 0}, {1, 0, pi - 0.1}};
  const std::vector<Pose> truth{{5, 5, 1}, compose(Pose{5, 5, 1}, Pose{1, 0.3, -pi + 0.1})};
  const JudgedMotions motions{
      MotionsOver::keyframes, 1.0, {{0, 1}}, {Eigen::Vector3d(1, 0.09, 0.01).asDiagonal()}};
  EXPECT_NEAR(relative_anees(estimate, truth, motions).value(), (1.0 + 4.0) / 3.0, 1e-9);
}

// Keyframes with errors of their own, and one more that keyframe 0's picture gives to all others.
struct BadFirstPicture {
  std::vector<Pose> truth{{}};
  std::vector<Pose> estimate{{}};
  std::vector<Eigen::Matrix3d> covariances{Eigen::Matrix3d::Zero()};

  explicit BadFirstPicture(std::uint64_t seed) {
    constexpr double kSigma = 0.01;
    RandomStream random(seed, "first picture");
    for (int k = 1; k < 60; ++k) {
      truth.push_back({0.1 * k, 0.0, 0.0});
      const Eigen::Vector3d error(4.0 + random.normal(), -3.0 + random.normal(), random.normal());
      estimate.push_back(Pose::from_vector(truth.back().vector() + kSigma * error));
      covariances.emplace_back(kSigma * kSigma * Eigen::Matrix3d::Identity());
    }
  }

  double anees_of(JudgedMotions motions) const {
    for (const auto& [from, to] : motions.pairs) {
      const PairCovariance pair{covariances[from], covariances[to], Eigen::Matrix3d::Zero()};
      motions.covariances.push_back(between(estimate[from], estimate[to], pair).covariance);
    }
    return relative_anees(estimate, truth, motions).value();
  }
};

// With it held every pose is off, and of the motions between the others none is.
TEST(RelativeAnees, ABadFirstPictureDecidesNothing) {
  constexpr int kDraws = 100;
  double plain = 0.0;
  double relative = 0.0;
  double anchored = 0.0;
  for (int draw = 0; draw < kDraws; ++draw) {
    const BadFirstPicture run(static_cast<std::uint64_t>(draw));
    plain += consistency(run.estimate, run.truth, run.covariances)->anees / kDraws;
    const auto groups = motions_to_judge(run.truth, {.rpe_keyframes = {10}, .rpe_distances_m = {}});
    ASSERT_EQ(groups.size(), 2u);
    relative += run.anees_of(groups[0]) / kDraws;
    anchored += run.anees_of(groups[1]) / kDraws;
  }
  EXPECT_NEAR(plain, 1.0 + 25.0 / 3.0, 0.3);
  // One of 20 motions is from or to keyframe 0, whose part in the mean is at most (25 / 3) / 20.
  for (const double value : {relative, anchored}) {
    EXPECT_GT(value, 0.9);
    EXPECT_LT(value, 1.5);
  }
}

TEST(RelativeAnees, IsNothingWhereSomethingIsMissing) {
  const std::vector<Pose> poses{{0, 0, 0}, {1, 0, 0}};
  const Eigen::Matrix3d one = Eigen::Matrix3d::Identity();
  const auto of = [&](const std::vector<Pose>& estimate, std::vector<KeyframePair> pairs,
                      std::vector<Eigen::Matrix3d> covariances) {
    return relative_anees(estimate, poses,
                          {MotionsOver::keyframes, 1.0, std::move(pairs), std::move(covariances)});
  };
  EXPECT_FALSE(of(poses, {{0, 1}}, {}));
  EXPECT_FALSE(of(poses, {}, {}));
  EXPECT_FALSE(of(poses, {{0, 1}}, {0.0 * one}));
  EXPECT_FALSE(of({{0, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}}, {{0, 1}}, {one}));
  EXPECT_EQ(of(poses, {{0, 1}}, {one}), 0.0);
  EXPECT_NE(test::input_error_of([&] { of(poses, {{0, 1}}, {one, one}); }), "");
}

}  // namespace
}  // namespace fathom
