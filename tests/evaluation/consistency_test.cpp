#include "fathom/evaluation/consistency.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/evaluation/alignment.hpp"
#include "support/input_error.hpp"
#include "support/numbers.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::kNaN;
using test::random_covariance;
using test::random_pose;
using testing::HasSubstr;

// A run whose errors are drawn from exactly the covariances it states, in a world of its own.
struct HonestRun {
  std::vector<Pose> reference;
  std::vector<Pose> estimate;
  std::vector<Eigen::Matrix3d> covariances;

  HonestRun(std::size_t keyframes, const Pose& estimate_world, std::uint64_t seed) {
    RandomStream random(seed, "honest run");
    for (std::size_t k = 0; k < keyframes; ++k) {
      reference.push_back(random_pose(random, 100.0));
      estimate.push_back(compose(estimate_world, reference.back()));
      covariances.push_back(random_covariance(random, 1e-3));
      if (k == 0) continue;
      const Eigen::Matrix3d L = covariances[k].llt().matrixL();
      const Eigen::Vector3d noise =
          L * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
      estimate[k] = Pose::from_vector(estimate[k].vector() + noise);
      estimate[k].theta = wrap_angle(estimate[k].theta);
    }
    covariances[0].setZero();
  }
};

// By hand: an error of one standard deviation along x at both keyframes, which `origin` takes away.
TEST(Consistency, OfAnUncertainStartTheWorldCounts) {
  const std::vector<Pose> reference{{0, 0, 0}, {1, 0, 0}};
  const std::vector<Pose> estimate{{0.1, 0, 0}, {1.1, 0, 0}};
  const std::vector<Eigen::Matrix3d> covariances(2, 0.01 * Eigen::Matrix3d::Identity());
  EXPECT_NEAR(consistency(estimate, reference, covariances)->anees, 0.0, 1e-15);
  EXPECT_NEAR(consistency(estimate, reference, covariances, Alignment::none)->anees, 1.0 / 3.0,
              1e-12);
}

TEST(Consistency, HonestRunInAnyWorld) {
  for (const Pose& world : {Pose{}, Pose{3, -2, std::numbers::pi / 2}, Pose{-50, 8, -2.7}}) {
    constexpr int kKeyframes = 5000;
    const HonestRun run(kKeyframes + 1, world, 11);
    const auto result = consistency(run.estimate, run.reference, run.covariances);
    ASSERT_TRUE(result);
    ASSERT_EQ(result->pose_nees.size(), std::size_t{kKeyframes});
    // Five standard deviations of the mean of 5000 draws of χ²₃/3, χ²₂/2 and of the share.
    EXPECT_NEAR(result->anees, 1.0, 5 * std::sqrt(2.0 / 3.0 / kKeyframes));
    EXPECT_NEAR(result->position_anees, 1.0, 5 * std::sqrt(1.0 / kKeyframes));
    EXPECT_NEAR(result->share_inside_2_sigma, kExpectedInside2Sigma,
                5 * std::sqrt(0.117 / kKeyframes));
  }
}

// The same numbers with the estimate's world turned: only a covariance that turns along gives that.
TEST(Consistency, DoesNotDependOnTheEstimatesWorld) {
  const HonestRun run(30, {}, 5);
  const auto expected = consistency(run.estimate, run.reference, run.covariances);
  const Pose world{4, 5, 1.3};
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = rotation(world.theta);
  std::vector<Pose> estimate;
  std::vector<Eigen::Matrix3d> covariances;
  for (std::size_t k = 0; k < run.estimate.size(); ++k) {
    estimate.push_back(compose(world, run.estimate[k]));
    covariances.push_back(R * run.covariances[k] * R.transpose());
  }
  const auto result = consistency(estimate, run.reference, covariances);
  ASSERT_TRUE(result);
  for (std::size_t i = 0; i < result->pose_nees.size(); ++i) {
    EXPECT_NEAR(result->pose_nees[i], expected->pose_nees[i], 1e-8 * expected->pose_nees[i]);
    EXPECT_NEAR(result->position_nees[i], expected->position_nees[i],
                1e-8 * expected->position_nees[i]);
  }
}

TEST(Consistency, HandNumbers) {
  // Long and narrow along world x; the estimate's world is turned a quarter, so the error along the
  // reference's y is along the estimate's x.
  const std::vector<Pose> reference{{0, 0, 0}, {10, 0, 0}};
  const std::vector<Pose> estimate{{0, 0, -std::numbers::pi / 2},
                                   {3.0, -10, -std::numbers::pi / 2 + 0.2}};
  const Eigen::Matrix3d P = Eigen::Vector3d(9.0, 0.01, 0.04).asDiagonal();
  const auto result =
      consistency(estimate, reference, std::vector<Eigen::Matrix3d>{Eigen::Matrix3d::Zero(), P});
  ASSERT_TRUE(result);
  EXPECT_NEAR(result->pose_nees[0], 9.0 / 9.0 + 0.04 / 0.04, 1e-9);
  EXPECT_NEAR(result->position_nees[0], 1.0, 1e-9);
  EXPECT_NEAR(result->anees, 2.0 / 3.0, 1e-9);
  EXPECT_NEAR(result->position_anees, 0.5, 1e-9);
  EXPECT_EQ(result->share_inside_2_sigma, 1.0);
}

TEST(Consistency, EqualsTheFullInverse) {
  const HonestRun run(40, {}, 6);
  const auto result = consistency(run.estimate, run.reference, run.covariances);
  for (std::size_t k = 1; k < 40; ++k) {
    Eigen::Vector3d e = run.estimate[k].vector() - run.reference[k].vector();
    e.z() = test::angle_between(run.estimate[k].theta, run.reference[k].theta);
    EXPECT_NEAR(result->pose_nees[k - 1], e.dot(run.covariances[k].inverse() * e), 1e-9);
  }
}

TEST(Consistency, TwiceTooConfidentIsFourTimesTheNees) {
  HonestRun run(200, {}, 7);
  const double honest = consistency(run.estimate, run.reference, run.covariances)->anees;
  for (Eigen::Matrix3d& P : run.covariances) P /= 4.0;
  EXPECT_NEAR(consistency(run.estimate, run.reference, run.covariances)->anees, 4 * honest, 1e-9);
}

TEST(Consistency, OneBadKeyframeIsNoResult) {
  const HonestRun good(6, {}, 8);
  ASSERT_TRUE(consistency(good.estimate, good.reference, good.covariances));
  const Eigen::Vector3d direction(1, 2, 3);
  const Eigen::Matrix3d singular = direction * direction.transpose();
  for (const Eigen::Matrix3d& bad : {Eigen::Matrix3d(Eigen::Matrix3d::Zero()), singular,
                                     Eigen::Matrix3d(-Eigen::Matrix3d::Identity()),
                                     Eigen::Matrix3d(Eigen::Matrix3d::Constant(kNaN)),
                                     Eigen::Matrix3d(Eigen::Vector3d(1, 1, 0).asDiagonal())}) {
    HonestRun run = good;
    run.covariances[4] = bad;
    EXPECT_FALSE(consistency(run.estimate, run.reference, run.covariances)) << bad;
    run = good;
    run.covariances[0] = bad;  // that of the fixed keyframe is not looked at
    EXPECT_TRUE(consistency(run.estimate, run.reference, run.covariances)) << bad;
  }
  HonestRun run = good;
  run.estimate[2].theta = kNaN;
  EXPECT_FALSE(consistency(run.estimate, run.reference, run.covariances));
  run = good;
  run.reference[5].y = kNaN;
  EXPECT_FALSE(consistency(run.estimate, run.reference, run.covariances));
}

TEST(Consistency, TooShortOrUnequal) {
  const std::vector<Pose> one(1);
  const std::vector<Eigen::Matrix3d> covariance(1, Eigen::Matrix3d::Identity());
  EXPECT_FALSE(consistency(one, one, covariance));
  EXPECT_FALSE(consistency({}, {}, {}));
  EXPECT_THAT(input_error_of([&] { consistency(one, one, {}); }),
              HasSubstr("1 poses and covariances 0"));
  EXPECT_THAT(input_error_of([&] { consistency(one, {}, covariance); }),
              HasSubstr("1 poses and the reference 0"));
}

// χ² quantiles by mpmath 1.3 (bisection on its incomplete gamma function with 40 digits); of 150
// degrees of freedom at 2.5 % and 97.5 %: 117.9845154029029 and 185.80044700379326, of 30 000:
// 29521.805937252692 and 30481.982656347922.
TEST(AneesInterval, RecordedNumbers) {
  const Interval fifty = anees_interval(50, 3, 0.95);
  EXPECT_NEAR(fifty.low, 117.9845154029029 / 150, 1e-12);
  EXPECT_NEAR(fifty.high, 185.80044700379326 / 150, 1e-12);
  const Interval many = anees_interval(10'000, 3, 0.95);
  EXPECT_NEAR(many.low, 29521.805937252692 / 30'000, 1e-10);
  EXPECT_NEAR(many.high, 30481.982656347922 / 30'000, 1e-10);
  EXPECT_TRUE(fifty.contains(1.0));
  EXPECT_FALSE(fifty.contains(0.78));
  EXPECT_FALSE(fifty.contains(1.24));
  EXPECT_FALSE(fifty.contains(kNaN));
}

TEST(AneesInterval, HoldsItsShareOfTrials) {
  RandomStream random(21, "interval");
  const Interval interval = anees_interval(10, 3, 0.9);
  int inside = 0;
  constexpr int kStudies = 4000;
  for (int study = 0; study < kStudies; ++study) {
    double sum = 0.0;
    for (int i = 0; i < 30; ++i) sum += std::pow(random.normal(), 2);
    if (interval.contains(sum / 30)) ++inside;
  }
  EXPECT_NEAR(inside / double{kStudies}, 0.9, 5 * std::sqrt(0.09 / kStudies));
}

TEST(AneesInterval, Refuses) {
  EXPECT_THAT(input_error_of([] { anees_interval(0, 3, 0.95); }), HasSubstr("at least 1 trial"));
  EXPECT_THAT(input_error_of([] { anees_interval(5, 0, 0.95); }), HasSubstr("degree of freedom"));
  for (const double probability : {0.0, 1.0, -0.1, 1.5, kNaN}) {
    EXPECT_THAT(input_error_of([&] { anees_interval(5, 3, probability); }),
                HasSubstr("between 0 and 1"));
  }
}

}  // namespace
}  // namespace fathom
