#include "fathom/vision/motion_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/vision/rigid_motion.hpp"

namespace fathom {
namespace {

using Points = std::vector<Eigen::Vector2d>;

Points random_points(RandomStream& random, int count, const Eigen::Vector2d& middle) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1.0, 1.0);
    points.push_back(middle + Eigen::Vector2d(x, random.uniform(-1.0, 1.0)));
  }
  return points;
}

Eigen::Vector2d noise(RandomStream& random, double sigma_m) {
  const double x = sigma_m * random.normal();
  return {x, sigma_m * random.normal()};
}

Points seen_from(const Pose& z, const Points& q) {
  Points p;
  for (const Eigen::Vector2d& point : q) p.push_back(transform(z, point));
  return p;
}

std::vector<double> random_weights(RandomStream& random, std::size_t count) {
  std::vector<double> weights;
  for (std::size_t j = 0; j < count; ++j) weights.push_back(std::exp(random.normal()));
  return weights;
}

Eigen::Vector3d difference(const Pose& a, const Pose& b) {
  return {a.x - b.x, a.y - b.y, wrap_angle(a.theta - b.theta)};
}

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

// What a camera is off by: altitude, and turns of the body about its x and y axes.
struct Error {
  double altitude_m = 0.0;
  double roll_rad = 0.0;
  double pitch_rad = 0.0;

  double& operator[](int i) { return i == 0 ? altitude_m : i == 1 ? roll_rad : pitch_rad; }
};

// Where the ray that a level camera takes for the one to `point` meets the floor with the error, in
// three dimensions: x ahead, y to the left, z up.
Eigen::Vector2d moved(const Eigen::Vector2d& point, const Viewpoint& view, const Error& error) {
  const Eigen::Vector3d ray(point.x() - view.camera_m.x(), point.y() - view.camera_m.y(),
                            -view.altitude_m);
  const Eigen::Vector3d turned =
      Eigen::AngleAxisd(error.roll_rad, Eigen::Vector3d::UnitX()) *
      (Eigen::AngleAxisd(error.pitch_rad, Eigen::Vector3d::UnitY()) * ray);
  const double length = -(view.altitude_m + error.altitude_m) / turned.z();
  return view.camera_m + length * turned.head<2>();
}

Points all_moved(const Points& points, const Viewpoint& view, const Error& error) {
  Points result;
  for (const Eigen::Vector2d& point : points) result.push_back(moved(point, view, error));
  return result;
}

struct Overlap {
  Pose motion{0.6, -0.4, 0.9};
  Viewpoint from{{0.4, -0.1}, 2.0, 0.0};
  Viewpoint to{{0.4, -0.1}, 1.4, 0.0};
  Points p, q;
  std::vector<double> weights;

  Overlap() {
    RandomStream random(8);
    q = random_points(random, 40, {0.9, 0.3});
    p = seen_from(motion, q);
    weights = random_weights(random, q.size());
  }
};

// σ² dz dzᵀ over the errors of both pictures, dz by central differences of whole fits.
Eigen::Matrix3d refitted(const Overlap& seen, const CovarianceOptions& options) {
  const double sigmas[] = {options.altitude_sigma_m, options.tilt_sigma_rad,
                           options.tilt_sigma_rad};
  constexpr double kStep = 1e-5;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int i = 0; i < 3; ++i) {
    Error up, down;
    up[i] = kStep;
    down[i] = -kStep;
    const auto fit = [&](const Error& of_from, const Error& of_to) {
      return find_motion(all_moved(seen.p, seen.from, of_from), all_moved(seen.q, seen.to, of_to),
                         seen.weights)
          .value();
    };
    const Eigen::Vector3d by_from = difference(fit(up, {}), fit(down, {})) / (2.0 * kStep);
    const Eigen::Vector3d by_to = difference(fit({}, up), fit({}, down)) / (2.0 * kStep);
    sum += sigmas[i] * sigmas[i] * (by_from * by_from.transpose() + by_to * by_to.transpose());
  }
  return sum;
}

TEST(LinearFit, AltitudeAndTiltEqualsRefitsOfMovedPoints) {
  const Overlap seen;
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  for (const CovarianceOptions& options :
       {CovarianceOptions{0.02, 0.0}, CovarianceOptions{0.0, 0.03},
        CovarianceOptions{0.02, 0.03}}) {
    const Eigen::Matrix3d expected = refitted(seen, options);
    const Eigen::Matrix3d found = fit.altitude_and_tilt(seen.from, seen.to, options);
    ASSERT_GT(expected.norm(), 1e-5);
    EXPECT_LT((found - expected).norm(), 1e-6 * expected.norm()) << found << "\n\n" << expected;
  }
}

TEST(LinearFit, AltitudeAndTiltKnowsOnePictureFromTheOther) {
  // An altitude of the far picture alone: lower ones move a point by more of a metre for a metre.
  const Overlap seen;
  const LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  const CovarianceOptions options{0.02, 0.0};
  const Eigen::Matrix3d both = fit.altitude_and_tilt(seen.from, seen.to, options);
  const Eigen::Matrix3d swapped = fit.altitude_and_tilt(seen.to, seen.from, options);
  EXPECT_GT((both - swapped).norm(), 0.1 * both.norm());
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
