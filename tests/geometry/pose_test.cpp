#include "fathom/geometry/pose.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "support/numbers.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::homogeneous;
using test::kInfinity;
using test::kNaN;
using test::kPi;
using test::numerical_jacobian;
using test::t2v;

TEST(WrapAngle, KeepsWhatIsInRange) {
  for (const double angle : {0.0, 1e-300, -1e-300, 3.0, -3.0, kPi, std::nextafter(-kPi, 0.0)}) {
    EXPECT_EQ(wrap_angle(angle), angle);
  }
}

TEST(WrapAngle, MinusPiIsPi) {
  EXPECT_EQ(wrap_angle(-kPi), kPi);
  EXPECT_EQ(wrap_angle(std::nextafter(-kPi, -4.0)), wrap_angle(std::nextafter(kPi, 0.0)));
}

TEST(WrapAngle, JustBeyondPiComesOutAtTheOtherEnd) {
  EXPECT_NEAR(wrap_angle(kPi + 1e-9), -kPi + 1e-9, 1e-15);
  EXPECT_NEAR(wrap_angle(-kPi - 1e-9), kPi - 1e-9, 1e-15);
  EXPECT_LT(wrap_angle(std::nextafter(kPi, 4.0)), 0.0);
}

TEST(WrapAngle, IsInRangeAndTheSameDirection) {
  RandomStream random(1, "angles");
  for (int i = 0; i < 10'000; ++i) {
    const double angle = random.uniform(-1e4, 1e4);
    const double wrapped = wrap_angle(angle);
    EXPECT_GT(wrapped, -kPi);
    EXPECT_LE(wrapped, kPi);
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-11);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-11);
  }
  for (const double huge : {1e15, -1e100, std::numeric_limits<double>::max()}) {
    EXPECT_LE(std::abs(wrap_angle(huge)), kPi);
  }
}

TEST(WrapAngle, NaNAndInfinityAreNaN) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) EXPECT_TRUE(std::isnan(wrap_angle(bad)));
}

TEST(Rotation, IsCounterClockwise) {
  const Eigen::Vector2d turned = rotation(kPi / 2) * Eigen::Vector2d(1, 0);
  EXPECT_NEAR(turned.x(), 0, 1e-15);
  EXPECT_NEAR(turned.y(), 1, 1e-15);
}

// Identity, random, near ±π and tiny angles: where a wrong sign or a wrong branch would show.
std::vector<Pose> places() {
  std::vector<Pose> poses{{},
                          {1, 2, 0},
                          {-3, 0.5, 1e-9},
                          {2, 2, -1e-12},
                          {4, -1, kPi},
                          {4, -1, -kPi + 1e-9},
                          {0, 7, kPi - 1e-9},
                          {1e-8, -1e-8, 1e-8}};
  RandomStream random(2, "poses");
  for (int i = 0; i < 12; ++i) poses.push_back(test::random_pose(random));
  return poses;
}

void expect_near(const Pose& pose, const Eigen::Matrix3d& T, double tolerance) {
  EXPECT_LT(test::distance(pose, Pose::from_vector(t2v(T))), tolerance);
  EXPECT_GT(pose.theta, -kPi);
  EXPECT_LE(pose.theta, kPi);
}

TEST(Pose, CompositionsEqualHomogeneousMatrices) {
  for (const Pose& X : places()) {
    expect_near(inverse(X), homogeneous(X).inverse(), 1e-14);
    for (const Pose& Y : places()) {
      expect_near(compose(X, Y), homogeneous(X) * homogeneous(Y), 1e-14);
      expect_near(between(X, Y), homogeneous(X).inverse() * homogeneous(Y), 1e-14);
    }
  }
}

TEST(Pose, TransformEqualsHomogeneousMatrices) {
  for (const Pose& X : places()) {
    const Eigen::Vector2d point(0.3, -1.7);
    const Eigen::Vector3d expected = homogeneous(X) * Eigen::Vector3d(0.3, -1.7, 1.0);
    EXPECT_LT((transform(X, point) - expected.head<2>()).norm(), 1e-14);
  }
}

// A group: what Smith, Self and Cheeseman's operations must satisfy whatever their formulas.
TEST(Pose, GroupLaws) {
  for (const Pose& X : places()) {
    EXPECT_LT(test::distance(compose(X, inverse(X)), {}), 1e-14);
    EXPECT_LT(test::distance(compose(inverse(X), X), {}), 1e-14);
    EXPECT_EQ(compose({}, X), X);
    EXPECT_EQ(between(X, X), (Pose{}));
    for (const Pose& Y : places()) {
      EXPECT_LT(test::distance(compose(X, between(X, Y)), Y), 1e-13);
      const Pose Z{0.7, -2, 2.2};
      EXPECT_LT(test::distance(compose(compose(X, Y), Z), compose(X, compose(Y, Z))), 1e-13);
    }
  }
}

TEST(Pose, JacobiansEqualCentralDifferences) {
  constexpr double kTolerance = 1e-7;  // of a step of 1e-6 on coordinates around 10
  for (const Pose& X : places()) {
    Eigen::Matrix3d inverse_X;
    inverse(X, &inverse_X);
    const auto inverse_of = [](const Pose& P) { return inverse(P).vector(); };
    EXPECT_LT((inverse_X - numerical_jacobian(inverse_of, X)).norm(), kTolerance);
    for (const Pose& Y : places()) {
      const auto differ = [&](auto operation) {
        Eigen::Matrix3d J_X;
        Eigen::Matrix3d J_Y;
        operation(X, Y, &J_X, &J_Y);
        const auto of_X = [&](const Pose& P) { return operation(P, Y, nullptr, nullptr).vector(); };
        const auto of_Y = [&](const Pose& P) { return operation(X, P, nullptr, nullptr).vector(); };
        return (J_X - numerical_jacobian(of_X, X)).norm() +
               (J_Y - numerical_jacobian(of_Y, Y)).norm();
      };
      using Operation = Pose(const Pose&, const Pose&, Eigen::Matrix3d*, Eigen::Matrix3d*);
      EXPECT_LT(differ(static_cast<Operation*>(compose)), kTolerance);
      EXPECT_LT(differ(static_cast<Operation*>(between)), kTolerance);
    }
  }
}

TEST(Pose, JacobiansAreOptionalOneByOne) {
  const Pose X{1, 2, 3};
  const Pose Y{-1, 0.5, 2};
  Eigen::Matrix3d both_X;
  Eigen::Matrix3d both_Y;
  Eigen::Matrix3d alone;
  const Pose sum = compose(X, Y, &both_X, &both_Y);
  EXPECT_EQ(compose(X, Y, &alone), sum);
  EXPECT_EQ(alone, both_X);
  EXPECT_EQ(compose(X, Y, nullptr, &alone), sum);
  EXPECT_EQ(alone, both_Y);
  const Pose difference = between(X, Y, &both_X, &both_Y);
  EXPECT_EQ(between(X, Y, &alone), difference);
  EXPECT_EQ(alone, both_X);
  EXPECT_EQ(between(X, Y, nullptr, &alone), difference);
  EXPECT_EQ(alone, both_Y);
}

TEST(Pose, FiniteOrNot) {
  EXPECT_TRUE(is_finite(Pose{1, 2, 3}));
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    EXPECT_FALSE(is_finite(Pose{bad, 0, 0}));
    EXPECT_FALSE(is_finite(Pose{0, bad, 0}));
    EXPECT_FALSE(is_finite(Pose{0, 0, bad}));
    EXPECT_FALSE(is_finite(compose(Pose{1, 2, 3}, Pose{bad, 0, 0})));
  }
}

}  // namespace
}  // namespace fathom
