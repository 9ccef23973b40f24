#include "fathom/measurements/relative_pose.hpp"

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "fathom/geometry/covariance.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::homogeneous;
using test::numerical_jacobian;
using test::random_covariance;
using test::random_pose;
using test::t2v;

constexpr double kPi = std::numbers::pi;

Eigen::Matrix3d rot3(double theta_rad) {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R(0, 0) = R(1, 1) = std::cos(theta_rad);
  R(1, 0) = std::sin(theta_rad);
  R(0, 1) = -R(1, 0);
  return R;
}

struct Case {
  Pose z;
  Pose A;
  Pose B;
};

// Random ones, the exact prediction, a residual near ±π, tiny angles.
std::vector<Case> cases() {
  std::vector<Case> cases{{{}, {}, {}},
                          {{1, 0, 0}, {0, 0, 0}, {1, 0, 0}},
                          {{1, 2, 0.5}, {3, 4, kPi}, {2, 1, -kPi + 0.5 + 1e-9}},
                          {{1, 2, -1.5}, {3, 4, 0}, {2, 1, kPi - 1.5 - 1e-3}},
                          {{1e-9, 0, 1e-9}, {0, 1e-9, -1e-9}, {0, 0, 1e-12}}};
  RandomStream random(1, "cases");
  for (int i = 0; i < 100; ++i) {
    cases.push_back({random_pose(random), random_pose(random), random_pose(random)});
  }
  return cases;
}

TEST(Residual, EqualsHomogeneousMatrices) {
  for (const auto& [z, A, B] : cases()) {
    const Eigen::Vector3d e = residual(z, A, B);
    const Eigen::Vector3d expected =
        t2v(homogeneous(z).inverse() * homogeneous(A).inverse() * homogeneous(B));
    EXPECT_LT((e - expected).head<2>().norm(), 1e-12);
    EXPECT_NEAR(test::angle_between(e.z(), expected.z()), 0, 1e-12);
    EXPECT_LE(std::abs(e.z()), kPi);
  }
}

TEST(Residual, JacobiansEqualCentralDifferences) {
  for (const auto& [z, A, B] : cases()) {
    Eigen::Matrix3d e_A;
    Eigen::Matrix3d e_B;
    residual(z, A, B, &e_A, &e_B);
    const Pose measured = z;
    const Pose from = A;
    const Pose to = B;
    const auto of_A = [&](const Pose& P) { return residual(measured, P, to); };
    const auto of_B = [&](const Pose& P) { return residual(measured, from, P); };
    EXPECT_LT((e_A - numerical_jacobian(of_A, A)).norm(), 1e-7);
    EXPECT_LT((e_B - numerical_jacobian(of_B, B)).norm(), 1e-7);
    Eigen::Matrix3d alone;
    residual(z, A, B, &alone);
    EXPECT_EQ(alone, e_A);
    residual(z, A, B, nullptr, &alone);
    EXPECT_EQ(alone, e_B);
  }
}

TEST(RelativePose, InformationIsTheTurnedCovariance) {
  RandomStream random(2, "information");
  for (int i = 0; i < 100; ++i) {
    const Pose z = random_pose(random);
    const Eigen::Matrix3d C = random_covariance(random, 0.01);
    const Eigen::Matrix3d expected = (rot3(z.theta).transpose() * C * rot3(z.theta)).inverse();
    const RelativePose measurement = RelativePose::from_covariance(3, 4, z, C);
    EXPECT_LT((measurement.information - expected).norm(), 1e-10 * expected.norm());
    EXPECT_LT((measurement.covariance() - C).norm(), 1e-10 * C.norm());
    EXPECT_EQ(measurement.information, measurement.information.transpose());
    EXPECT_EQ(measurement.covariance(), measurement.covariance().transpose());
    EXPECT_EQ(measurement.from, 3U);
    EXPECT_EQ(measurement.to, 4U);
    EXPECT_EQ(measurement.motion, z);
    EXPECT_FALSE(measurement.inliers);
  }
}

// A filter's cost νᵀ R⁻¹ ν with ν = z − h(x) is the graph's eᵀ Ω e, to the last digits.
TEST(RelativePose, FilterAndGraphHaveTheSameCost) {
  RandomStream random(3, "cost");
  for (int i = 0; i < 200; ++i) {
    const Pose A = random_pose(random);
    const Pose B = random_pose(random);
    const Eigen::Matrix3d C = random_covariance(random, 0.1);
    const RelativePose measurement = RelativePose::from_covariance(0, 1, random_pose(random), C);
    const Pose h = Pose::from_vector(t2v(homogeneous(A).inverse() * homogeneous(B)));
    Eigen::Vector3d nu = measurement.motion.vector() - h.vector();
    nu.z() = test::angle_between(measurement.motion.theta, h.theta);
    const double filter = nu.dot(C.inverse() * nu);
    EXPECT_NEAR(chi2(measurement, A, B), filter, 1e-9 * filter);
  }
}

// g2o's own convention by hand: z = 1 m ahead, turned left a quarter; the later pose lies 0.1 m
// further along the first one's x, which is −y of the frame at z.
TEST(RelativePose, ResidualIsInTheFrameOfTheLaterPose) {
  const Eigen::Vector3d e = residual({1, 0, kPi / 2}, {}, {1.1, 0, kPi / 2});
  EXPECT_NEAR(e.x(), 0, 1e-15);
  EXPECT_NEAR(e.y(), -0.1, 1e-15);
  RelativePose measurement;
  measurement.motion = {1, 0, kPi / 2};
  measurement.information = Eigen::Vector3d(1, 400, 9).asDiagonal();
  EXPECT_NEAR(chi2(measurement, {}, {1.1, 0, kPi / 2}), 4.0, 1e-12);
}

TEST(Forward, KeepsAForwardMeasurementToTheBit) {
  RandomStream random(4, "forward");
  RelativePose z =
      RelativePose::from_covariance(2, 7, random_pose(random), random_covariance(random));
  z.inliers = 31;
  const RelativePose same = z.forward();
  EXPECT_EQ(same.from, 2U);
  EXPECT_EQ(same.to, 7U);
  EXPECT_EQ(same.motion, z.motion);
  EXPECT_EQ(same.information, z.information);
  EXPECT_EQ(same.inliers, 31);
}

TEST(Forward, TurnsABackwardMeasurementRound) {
  RandomStream random(5, "backward");
  for (int i = 0; i < 50; ++i) {
    RelativePose z =
        RelativePose::from_covariance(9, 4, random_pose(random), random_covariance(random, 1e-3));
    z.inliers = 12;
    const RelativePose turned = z.forward();
    EXPECT_EQ(turned.from, 4U);
    EXPECT_EQ(turned.to, 9U);
    EXPECT_EQ(turned.newest(), 9U);
    EXPECT_EQ(turned.inliers, 12);
    EXPECT_LT(
        test::distance(turned.motion, Pose::from_vector(t2v(homogeneous(z.motion).inverse()))),
        1e-13);
    // First order: J C Jᵀ with the numerical Jacobian of the inverse.
    const auto inverse_of = [](const Pose& P) { return t2v(homogeneous(P).inverse()); };
    const Eigen::Matrix3d J = numerical_jacobian(inverse_of, z.motion);
    const Eigen::Matrix3d expected = J * z.covariance() * J.transpose();
    EXPECT_LT((turned.covariance() - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(Forward, TwiceRoundIsTheSameMeasurement) {
  RandomStream random(6, "twice");
  for (int i = 0; i < 50; ++i) {
    const RelativePose z =
        RelativePose::from_covariance(9, 4, random_pose(random), random_covariance(random));
    RelativePose turned = z.forward();
    std::swap(turned.from, turned.to);  // says "backward" of what is forward
    const RelativePose again = turned.forward();
    EXPECT_LT(test::distance(again.motion, z.motion), 1e-12);
    EXPECT_LT((again.information - z.information).norm(), 1e-8 * z.information.norm());
  }
}

// Near the measurement the cost is the same written either way: first order is all that is lost.
TEST(Forward, KeepsTheCostToFirstOrder) {
  RandomStream random(7, "first order");
  for (int i = 0; i < 50; ++i) {
    const RelativePose z =
        RelativePose::from_covariance(1, 0, random_pose(random), random_covariance(random));
    const Pose later = random_pose(random);
    const Pose nudge{1e-5 * random.normal(), 1e-5 * random.normal(), 1e-5 * random.normal()};
    const Pose earlier = compose(compose(later, z.motion), nudge);
    const double as_written = chi2(z, later, earlier);
    EXPECT_NEAR(chi2(z.forward(), earlier, later), as_written, 3e-3 * as_written);
  }
}

}  // namespace
}  // namespace fathom
