#include "fathom/geometry/covariance.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/planar.hpp"

namespace fathom {
namespace {

using test::random_covariance;
using test::random_pose;

Eigen::Vector3d draw(const UncertainPose& X, RandomStream& random) {
  const Eigen::Matrix3d L = X.covariance.llt().matrixL();
  return X.mean.vector() + L * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
}

// Sample covariance of an operation on independent draws, about the operation on the means.
template <class Operation>
Eigen::Matrix3d sampled(const UncertainPose& X, const UncertainPose& Y, Operation operation) {
  RandomStream random(5, "samples");
  const Pose centre = operation(X.mean, Y.mean);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kSamples = 10'000;
  for (int i = 0; i < kSamples; ++i) {
    const Pose result =
        operation(Pose::from_vector(draw(X, random)), Pose::from_vector(draw(Y, random)));
    Eigen::Vector3d d = result.vector() - centre.vector();
    d.z() = test::angle_between(result.theta, centre.theta);
    sum += d * d.transpose();
  }
  return sum / kSamples;
}

TEST(CovarianceTransport, EqualsMonteCarlo) {
  RandomStream random(6, "cases");
  for (int i = 0; i < 4; ++i) {
    const UncertainPose X{random_pose(random), random_covariance(random, 1e-4)};
    const UncertainPose Y{random_pose(random), random_covariance(random, 1e-4)};
    const auto expect_close = [](const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
      EXPECT_LT((a - b).norm(), 0.06 * b.norm()) << a << "\n\n" << b;
    };
    expect_close(compose(X, Y).covariance,
                 sampled(X, Y, [](const Pose& A, const Pose& B) { return compose(A, B); }));
    expect_close(between(X, Y).covariance,
                 sampled(X, Y, [](const Pose& A, const Pose& B) { return between(A, B); }));
    expect_close(inverse(X).covariance,
                 sampled(X, Y, [](const Pose& A, const Pose&) { return inverse(A); }));
  }
}

// x = r cos, y = r sin of a step r along a heading: the closed form of Smith, Self and Cheeseman.
TEST(CovarianceTransport, ClosedFormOfAHeadingError) {
  UncertainPose X{{0, 0, std::numbers::pi / 2}, Eigen::Matrix3d::Zero()};
  X.covariance(2, 2) = 0.01;
  const UncertainPose result = compose(X, UncertainPose{{10, 0, 0}, Eigen::Matrix3d::Zero()});
  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected(0, 0) = 100 * 0.01;
  expected(2, 2) = 0.01;
  expected(0, 2) = expected(2, 0) = -10 * 0.01;
  EXPECT_LT((result.covariance - expected).norm(), 1e-15);
}

TEST(CovarianceTransport, IsSymmetricToTheLastBit) {
  RandomStream random(7, "symmetry");
  for (int i = 0; i < 1000; ++i) {
    const UncertainPose X{random_pose(random), random_covariance(random)};
    const UncertainPose Y{random_pose(random), random_covariance(random)};
    for (const Eigen::Matrix3d& C : {compose(X, Y).covariance, inverse(X).covariance,
                                     between(X, Y).covariance, symmetric_inverse(X.covariance)}) {
      EXPECT_EQ(C, C.transpose());
    }
  }
}

TEST(CovarianceTransport, InverseTwiceIsTheSame) {
  RandomStream random(8, "twice");
  for (int i = 0; i < 100; ++i) {
    const UncertainPose X{random_pose(random), random_covariance(random)};
    const UncertainPose again = inverse(inverse(X));
    EXPECT_LT(test::distance(again.mean, X.mean), 1e-13);
    EXPECT_LT((again.covariance - X.covariance).norm(), 1e-10 * X.covariance.norm());
  }
}

// The whole chain as one function of 3n numbers, its Jacobian by central differences.
TEST(ComposeChain, EqualsOneStackedJacobian) {
  RandomStream random(9, "chain");
  constexpr int kMotions = 8;
  std::vector<UncertainPose> chain;
  Eigen::MatrixXd blocks = Eigen::MatrixXd::Zero(3 * kMotions, 3 * kMotions);
  for (int i = 0; i < kMotions; ++i) {
    chain.push_back({random_pose(random, 3.0), random_covariance(random, 0.01)});
    blocks.block<3, 3>(3 * i, 3 * i) = chain.back().covariance;
  }
  Eigen::MatrixXd J(3, 3 * kMotions);
  for (int i = 0; i < kMotions; ++i) {
    const auto end_of = [&](const Pose& motion) -> Eigen::Vector3d {
      Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
      for (int k = 0; k < kMotions; ++k) {
        T = T * test::homogeneous(k == i ? motion : chain[static_cast<std::size_t>(k)].mean);
      }
      return test::t2v(T);
    };
    J.middleCols<3>(3 * i) =
        test::numerical_jacobian(end_of, chain[static_cast<std::size_t>(i)].mean);
  }
  const Eigen::Matrix3d expected = J * blocks * J.transpose();
  EXPECT_LT((compose_chain(chain).covariance - expected).norm(), 1e-7 * expected.norm());
}

TEST(ComposeChain, OfNoneIsTheExactIdentity) {
  const UncertainPose none = compose_chain({});
  EXPECT_EQ(none.mean, Pose{});
  EXPECT_EQ(none.covariance, Eigen::Matrix3d::Zero());
}

TEST(PositiveDefinite, WhateverTheUnits) {
  RandomStream random(10, "units");
  for (const double scale : {1e-16, 1e-8, 1.0, 1e8}) {
    EXPECT_TRUE(is_positive_definite(scale * Eigen::Matrix3d::Identity()));
    EXPECT_TRUE(is_positive_definite(random_covariance(random, scale)));
  }
  // Metres beside a heading known to 1e-8 rad, and the information of it.
  EXPECT_TRUE(is_positive_definite(Eigen::Vector3d(1, 1, 1e-16).asDiagonal()));
  EXPECT_TRUE(is_positive_definite(Eigen::Vector3d(1, 1, 1e16).asDiagonal()));
}

TEST(PositiveDefinite, RefusesTheRest) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::Matrix3d correlated = Eigen::Matrix3d::Identity();
  correlated(0, 1) = correlated(1, 0) = 1.0;
  Eigen::Matrix3d overcorrelated = correlated;
  overcorrelated(0, 1) = overcorrelated(1, 0) = -1.001;
  Eigen::Matrix3d hidden_nan = Eigen::Matrix3d::Identity();
  hidden_nan(0, 2) = hidden_nan(2, 0) = nan;
  for (const Eigen::Matrix3d& bad :
       {Eigen::Matrix3d(Eigen::Matrix3d::Zero()), Eigen::Matrix3d(-Eigen::Matrix3d::Identity()),
        Eigen::Matrix3d(Eigen::Vector3d(1, 0, 1).asDiagonal()),
        Eigen::Matrix3d(Eigen::Vector3d(1, 1, -1e-9).asDiagonal()), correlated, overcorrelated,
        hidden_nan, Eigen::Matrix3d(Eigen::Vector3d(1, infinity, 1).asDiagonal())}) {
    EXPECT_FALSE(is_positive_definite(bad)) << bad;
  }
}

TEST(SymmetricInverse, EqualsTheGeneralOneAtEveryScale) {
  RandomStream random(11, "inverse");
  for (const double scale : {1e-12, 1.0, 1e8}) {
    for (int i = 0; i < 50; ++i) {
      Eigen::Matrix3d matrix = random_covariance(random, scale);
      const Eigen::Matrix3d expected = matrix.inverse();
      EXPECT_LT((symmetric_inverse(matrix) - expected).norm(), 1e-10 * expected.norm());
    }
  }
  const Eigen::Matrix3d mixed = Eigen::Vector3d(4, 1, 1e-16).asDiagonal();
  const Eigen::Matrix3d inverted = symmetric_inverse(mixed);
  EXPECT_DOUBLE_EQ(inverted(0, 0), 0.25);
  EXPECT_DOUBLE_EQ(inverted(2, 2), 1e16);
}

// Of poses that are correlated, by differences of the joint motion.
TEST(PairCovariance, IsThatOfTheMotionBetweenCorrelatedPoses) {
  RandomStream random(12, "pair");
  for (int i = 0; i < 50; ++i) {
    Pose A = test::random_pose(random);
    Pose B = test::random_pose(random);
    if (i % 5 == 1) B = A;
    if (i % 5 == 2) B.theta = wrap_angle(A.theta + M_PI - 1e-9);
    if (i % 5 == 3) A = B = Pose{1e-8, -1e-8, 1e-8};
    Eigen::Matrix<double, 6, 6> root;
    for (Eigen::Index j = 0; j < root.size(); ++j) root.data()[j] = random.normal();
    const Eigen::Matrix<double, 6, 6> C = root * root.transpose();
    const auto motion = [](const Pose& a, const Pose& b) {
      return test::t2v(test::homogeneous(a).inverse() * test::homogeneous(b));
    };
    Eigen::Matrix<double, 3, 6> J;
    J << test::numerical_jacobian([&](const Pose& a) { return motion(a, B); }, A),
        test::numerical_jacobian([&](const Pose& b) { return motion(A, b); }, B);
    const UncertainPose found =
        between(A, B,
                PairCovariance{C.topLeftCorner<3, 3>(), C.bottomRightCorner<3, 3>(),
                               C.topRightCorner<3, 3>()});
    const Eigen::Matrix3d expected = J * C * J.transpose();
    EXPECT_LT((found.covariance - expected).norm(), 1e-7 * expected.norm());
    EXPECT_LT(test::distance(found.mean, Pose::from_vector(motion(A, B))), 1e-12);
  }
}

}  // namespace
}  // namespace fathom
