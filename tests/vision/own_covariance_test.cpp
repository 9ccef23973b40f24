// What is a registration's own where its pictures' altitudes and tilts are off.

#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "src/vision/motion_bends.hpp"
#include "src/vision/motion_covariance.hpp"
#include "src/vision/rigid_motion.hpp"
#include "vision/fitted_points.hpp"
#include "vision/moved_points.hpp"

namespace fathom {
namespace {

using test::all_moved;
using test::CameraError;
using test::noise;
using test::Overlap;
using test::Points;

constexpr double kSigmaM = 0.002;
const CovarianceOptions kAll{0.1, 0.1};

// Both pictures off by much more than their matches are, and noise.
Overlap tilted(RandomStream& random, int matches) {
  Overlap seen(matches);
  for (std::size_t j = 0; j < seen.p.size(); ++j) {
    seen.p[j] += noise(random, kSigmaM / std::sqrt(seen.weights[j]));
  }
  seen.p = all_moved(seen.p, seen.from, {0.02, 0.010, -0.007});
  seen.q = all_moved(seen.q, seen.to, {-0.01, -0.004, 0.010});
  seen.motion = find_motion(seen.p, seen.q, seen.weights).value();
  return seen;
}

// √w (J, what each error does to the points) by central differences of what a camera sees.
Eigen::MatrixXd dense_columns(const Overlap& seen) {
  constexpr double kStep = 1e-6;
  const Points at_fit = test::seen_from(seen.motion, seen.q);
  Eigen::MatrixXd B(2 * static_cast<Eigen::Index>(seen.q.size()), 9);
  for (std::size_t j = 0; j < seen.q.size(); ++j) {
    const auto row = 2 * static_cast<Eigen::Index>(j);
    const double root = std::sqrt(seen.weights[j]);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      const auto at = [&](double sign) {
        return transform(Pose::from_vector(seen.motion.vector() + sign * step), seen.q[j]);
      };
      CameraError up, down;
      up[i] = kStep;
      down[i] = -kStep;
      const auto of_to = [&](const CameraError& error) {
        return transform(seen.motion, test::moved(seen.q[j], seen.to, error));
      };
      B.block<2, 1>(row, i) = root * (at(1.0) - at(-1.0)) / (2.0 * kStep);
      B.block<2, 1>(row, 3 + i) =
          root * (test::moved(at_fit[j], seen.from, up) - test::moved(at_fit[j], seen.from, down)) /
          (2.0 * kStep);
      B.block<2, 1>(row, 6 + i) = root * (of_to(up) - of_to(down)) / (2.0 * kStep);
    }
  }
  return B;
}

TEST(OwnCovariance, EqualsADenseFitOfMotionAltitudesAndTilts) {
  RandomStream random(21);
  for (const int matches : {12, 40, 200}) {
    const Overlap seen = tilted(random, matches);
    const Eigen::MatrixXd B = dense_columns(seen);
    Eigen::VectorXd r(B.rows());
    for (std::size_t j = 0; j < seen.q.size(); ++j) {
      r.segment<2>(2 * static_cast<Eigen::Index>(j)) =
          std::sqrt(seen.weights[j]) * (seen.p[j] - transform(seen.motion, seen.q[j]));
    }
    // Both altitudes do the same but for a shift: eight unknowns, as a homography has.
    Eigen::JacobiSVD<Eigen::MatrixXd> svd(B, Eigen::ComputeThinU | Eigen::ComputeThinV);
    svd.setThreshold(1e-7);
    ASSERT_EQ(svd.rank(), 8);
    const Eigen::VectorXd left = r - B * svd.solve(r);
    const double variance = left.squaredNorm() / static_cast<double>(B.rows() - 8);
    const Eigen::MatrixXd J = B.leftCols(3);
    const Eigen::Matrix3d expected = variance * (J.transpose() * J).inverse();

    LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
    const Eigen::Matrix3d before = fit.covariance();
    const double ratio = fit.take_out_altitude_and_tilt(seen.from, seen.to, kAll);
    const Eigen::Matrix3d found = fit.covariance();
    EXPECT_LT((found - expected).norm(), 1e-5 * expected.norm()) << matches;
    EXPECT_LT((found - ratio * ratio * before).norm(), 1e-12 * found.norm());
    EXPECT_LT(ratio, 0.5);
  }
}

TEST(OwnCovariance, IsThatOfTheNoiseWhateverTheTilt) {
  RandomStream random(22);
  constexpr int kTrials = 300;
  double variance = 0.0;
  double clustering = 0.0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const Overlap seen = tilted(random, 120);
    LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
    const double ratio = fit.take_out_altitude_and_tilt(seen.from, seen.to, kAll);
    double squares = 0.0;
    for (std::size_t j = 0; j < seen.p.size(); ++j) {
      squares += seen.weights[j] * (seen.p[j] - transform(seen.motion, seen.q[j])).squaredNorm() /
                 (240.0 - 3.0);
    }
    variance += ratio * ratio * squares / kTrials;
    clustering += fit.clustering(0.05, 6) / kTrials;
  }
  // The mean of σ² over 300 × 232 degrees of freedom has a relative σ of 0.0054; an altitude of 1 %
  // more stretches the noise of `from` with its points.
  EXPECT_NEAR(variance, 1.01 * 1.01 * kSigmaM * kSigmaM, 0.022 * kSigmaM * kSigmaM);
  EXPECT_LT(clustering, 1.15);
}

TEST(OwnCovariance, StaysWhereNothingIsTold) {
  RandomStream random(23);
  Overlap seen = tilted(random, 40);
  LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  const Eigen::Matrix3d before = fit.covariance();
  EXPECT_EQ(fit.take_out_altitude_and_tilt(seen.from, seen.to, {0.0, 0.0}), 1.0);
  EXPECT_EQ(fit.covariance(), before);
  // As much by what sensors state.
  seen.from.tilt_sigma_rad = seen.to.tilt_sigma_rad = 0.0;
  EXPECT_EQ(fit.take_out_altitude_and_tilt(seen.from, seen.to, {0.0, 0.1}), 1.0);
  seen.to.tilt_sigma_rad = 0.1;
  EXPECT_LT(fit.take_out_altitude_and_tilt(seen.from, seen.to, {0.0, 0.0}), 1.0);
  EXPECT_NE(fit.covariance(), before);
}

// Points without a picture; and too few to tell more than a motion.
TEST(OwnCovariance, StaysWhereNothingCanBeTold) {
  RandomStream random(24);
  Overlap seen = tilted(random, 4);
  LinearFit few(seen.motion, seen.p, seen.q, seen.weights);
  EXPECT_EQ(few.take_out_altitude_and_tilt(seen.from, seen.to, kAll), 1.0);
  seen = tilted(random, 40);
  LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  EXPECT_EQ(fit.take_out_altitude_and_tilt({}, seen.to, kAll), 1.0);
}

// Two pictures of one place: the errors of either are the same, and six unknowns are left.
TEST(OwnCovariance, OfPicturesFromOnePlace) {
  RandomStream random(25);
  Overlap seen(60);
  seen.motion = {};
  seen.to = seen.from;
  seen.p = seen.q;
  double squares = 0.0;
  for (Eigen::Vector2d& point : seen.p) point += noise(random, kSigmaM);
  seen.weights.assign(60, 1.0);
  seen.motion = find_motion(seen.p, seen.q, seen.weights).value();
  for (std::size_t j = 0; j < 60; ++j) {
    squares += (seen.p[j] - transform(seen.motion, seen.q[j])).squaredNorm();
  }
  LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  const double ratio = fit.take_out_altitude_and_tilt(seen.from, seen.to, kAll);
  EXPECT_TRUE(fit.covariance().allFinite());
  EXPECT_NEAR(ratio * ratio * squares / 117.0, kSigmaM * kSigmaM, 0.5 * kSigmaM * kSigmaM);
}

// ½ ∂²z/∂n² as second differences of whole fits to moved points, then the second moment of it as a
// sum over the products of normal variables.
Eigen::Matrix3d refitted_bend(const Overlap& seen, bool of_from) {
  constexpr double kStep = 1e-3;
  const auto fit = [&](double roll, double pitch) {
    const CameraError error{0.0, kStep * roll, kStep * pitch};
    return find_motion(of_from ? all_moved(seen.p, seen.from, error) : seen.p,
                       of_from ? seen.q : all_moved(seen.q, seen.to, error), seen.weights)
        .value()
        .vector();
  };
  const Eigen::Vector3d at = fit(0.0, 0.0);
  const Eigen::Vector3d rr = (fit(1.0, 0.0) + fit(-1.0, 0.0) - 2.0 * at) / (kStep * kStep);
  const Eigen::Vector3d pp = (fit(0.0, 1.0) + fit(0.0, -1.0) - 2.0 * at) / (kStep * kStep);
  const Eigen::Vector3d rp =
      (fit(1.0, 1.0) + fit(-1.0, -1.0) - fit(1.0, -1.0) - fit(-1.0, 1.0)) / (4.0 * kStep * kStep);
  // E r⁴ = 3, E r² p² = 1.
  return 0.25 * (3.0 * (rr * rr.transpose() + pp * pp.transpose()) + rr * pp.transpose() +
                 pp * rr.transpose()) +
         rp * rp.transpose();
}

TEST(OwnCovariance, BendsEqualSecondDifferencesOfRefits) {
  for (const double pitch_rad : {0.0, 0.3}) {
    Overlap seen;
    seen.from.pitch_rad = pitch_rad;
    seen.to.pitch_rad = -pitch_rad;
    const auto [from, to] = motion_bends(seen.motion, seen.q, seen.weights, seen.from, seen.to);
    const Eigen::Matrix3d of_from = refitted_bend(seen, true);
    const Eigen::Matrix3d of_to = refitted_bend(seen, false);
    EXPECT_LT((from - of_from).norm(), 1e-4 * of_from.norm()) << from << "\n\n" << of_from;
    EXPECT_LT((to - of_to).norm(), 1e-4 * of_to.norm()) << to << "\n\n" << of_to;
  }
  const Overlap seen;
  const auto [from, to] = motion_bends(seen.motion, seen.q, seen.weights, {}, seen.to);
  EXPECT_EQ(from, Eigen::Matrix3d::Zero());
  EXPECT_EQ(to, Eigen::Matrix3d::Zero());
}

TEST(OwnCovariance, OfExactPointsIsZero) {
  const Overlap seen(30);
  LinearFit fit(seen.motion, seen.p, seen.q, seen.weights);
  fit.take_out_altitude_and_tilt(seen.from, seen.to, kAll);
  EXPECT_LT(fit.covariance().norm(), 1e-15);
  EXPECT_EQ(fit.clustering(0.05, 6), 1.0);
}

}  // namespace
}  // namespace fathom
