#include "src/vision/motion_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "src/vision/rigid_motion.hpp"
#include "vision/fitted_points.hpp"

namespace fathom {
namespace {

using test::difference;
using test::noise;
using test::Points;
using test::random_points;
using test::random_weights;
using test::seen_from;

// J by central differences and W as a dense matrix; (JᵀWJ)⁻¹ by a general inverse.
Eigen::Matrix3d dense_covariance(const Pose& z, const Points& p, const Points& q,
                                 const std::vector<double>& weights) {
  const auto rows = 2 * static_cast<Eigen::Index>(q.size());
  Eigen::MatrixXd J(rows, 3);
  Eigen::MatrixXd W = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::VectorXd r(rows);
  constexpr double kStep = 1e-6;
  for (std::size_t j = 0; j < q.size(); ++j) {
    const auto row = 2 * static_cast<Eigen::Index>(j);
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      J.block<2, 1>(row, axis) = (transform(Pose::from_vector(z.vector() + step), q[j]) -
                                  transform(Pose::from_vector(z.vector() - step), q[j])) /
                                 (2.0 * kStep);
    }
    W(row, row) = W(row + 1, row + 1) = weights[j];
    r.segment<2>(row) = p[j] - transform(z, q[j]);
  }
  const double variance = r.dot(W * r) / static_cast<double>(rows - 3);
  return variance * (J.transpose() * W * J).inverse();
}

TEST(LinearFit, CovarianceEqualsTheNormalEquationsByNumericDifferences) {
  RandomStream random(5);
  for (int i = 0; i < 30; ++i) {
    const Points q = random_points(random, 2 + i, {3.0, -1.0});
    Points p = seen_from({1.0, -2.0, random.uniform(-3.0, 3.0)}, q);
    for (Eigen::Vector2d& point : p) point += noise(random, 0.1);
    const std::vector<double> weights = random_weights(random, q.size());
    const Pose z = find_motion(p, q, weights).value();
    const Eigen::Matrix3d expected = dense_covariance(z, p, q, weights);
    const Eigen::Matrix3d found = LinearFit(z, p, q, weights).covariance();
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(LinearFit, CovarianceIsWhatRepeatedFitsScatterBy) {
  // The points lie to one side of the origin, so that position and heading are strongly correlated;
  // their errors are as unlike as their weights say.
  RandomStream random(6);
  const Points q = random_points(random, 100, {2.0, 1.0});
  const std::vector<double> weights = random_weights(random, q.size());
  const Pose truth{0.5, -0.3, 0.8};
  constexpr int kTrials = 2000;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d reported = Eigen::Matrix3d::Zero();
  double nis = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Points p = seen_from(truth, q);
    for (std::size_t j = 0; j < p.size(); ++j) p[j] += noise(random, 0.05 / std::sqrt(weights[j]));
    const Pose z = find_motion(p, q, weights).value();
    const Eigen::Vector3d nu = difference(z, truth);
    const Eigen::Matrix3d C = LinearFit(z, p, q, weights).covariance();
    scatter += nu * nu.transpose() / kTrials;
    reported += C / kTrials;
    nis += nu.dot(C.ldlt().solve(nu)) / kTrials;
  }
  // σ² is estimated with 197 degrees of freedom, so NIS/3 is F(3, 197) with mean 197/195. Of 2000
  // of them 99.9 % of means lie within 3.29 √(6/2000) = 0.18 of it.
  EXPECT_NEAR(nis, 3.0 * 197.0 / 195.0, 0.18);
  // A variance from 2000 trials has a relative σ of √(2/2000) = 0.032; take four.
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      EXPECT_NEAR(scatter(i, j), reported(i, j), 0.13 * std::sqrt(reported(i, i) * reported(j, j)));
    }
  }
}

TEST(LinearFit, CovarianceOfExactPointsIsZero) {
  const Points q{{0.0, 0.0}, {1.0, 0.0}, {0.0, 1.0}};
  const std::vector<double> weights(3, 2.0);
  EXPECT_LT(LinearFit({}, q, q, weights).covariance().norm(), 1e-15);
}

constexpr double kCellM = 0.2;

// `copies` points in each of `cells` cells, all with the one error of their cell; the mean of
// clustering() over some draws.
double mean_clustering(int cells, int copies) {
  constexpr int kTrials = 60;
  RandomStream random(7);
  double sum = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    Points p, q;
    for (int i = 0; i < cells; ++i) {
      // Cells are about the multiples of their side.
      const Eigen::Vector2d middle = kCellM * Eigen::Vector2d(i % 12, i / 12);
      const Eigen::Vector2d error = noise(random, 0.01);
      for (int k = 0; k < copies; ++k) {
        const double x = random.uniform(-0.4, 0.4) * kCellM;
        q.push_back(middle + Eigen::Vector2d(x, random.uniform(-0.4, 0.4) * kCellM));
        p.push_back(transform({0.3, 0.1, 0.7}, q.back()) + error);
      }
    }
    const std::vector<double> weights(p.size(), 1.0);
    const Pose z = find_motion(p, q, weights).value();
    sum +=
        LinearFit(z, p, q, weights).clustering(kCellM, CovarianceTuning{}.least_clusters) / kTrials;
  }
  return sum;
}

TEST(LinearFit, ClusteringIsOneForIndependentErrors) {
  // A ratio estimated from 144 cells scatters by some 0.1, and what is below 1 counts as 1.
  EXPECT_LT(mean_clustering(144, 1), 1.12);
}

TEST(LinearFit, ClusteringIsTheNumberOfErrorsThatAreAlike) {
  EXPECT_NEAR(mean_clustering(144, 4), 4.0, 0.3);
  EXPECT_NEAR(mean_clustering(144, 10), 10.0, 0.8);
}

TEST(LinearFit, ClusteringNeedsSomeCells) {
  EXPECT_NEAR(mean_clustering(5, 10), 1.0, 1e-12);
  EXPECT_GT(mean_clustering(24, 10), 5.0);
}

TEST(LinearFit, ClusteringOfExactPointsIsOne) {
  Points q;
  for (int i = 0; i < 30; ++i) q.emplace_back(i % 6, i / 6);
  const std::vector<double> weights(q.size(), 1.0);
  EXPECT_EQ(LinearFit({}, q, q, weights).clustering(kCellM, CovarianceTuning{}.least_clusters),
            1.0);
}

TEST(SharedError, IsAShareOfTheErrorOfOneMatchInTranslationAlone) {
  // An error of 10 mm is one of 7.1 mm in x and in y.
  const double variance = 0.055 * 0.055 * 0.01 * 0.01 / 2.0;
  const Eigen::Matrix3d expected = Eigen::Vector3d(variance, variance, 0.0).asDiagonal();
  EXPECT_LT((shared_error(0.01, 0.055) - expected).norm(), 1e-15);
  EXPECT_EQ(shared_error(0.0, 0.055), Eigen::Matrix3d::Zero());
}

}  // namespace
}  // namespace fathom
