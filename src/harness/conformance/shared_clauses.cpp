// What an estimator makes of errors that registrations of one picture share.

#include <memory>

#include <Eigen/Eigenvalues>

#include "clauses.hpp"
#include "expectations.hpp"
#include "fathom/geometry/covariance.hpp"
#include "logs.hpp"
#include "naive_least_squares.hpp"

namespace fathom::conformance {
namespace {

// The circle, each registration told apart: half of its covariance is its own, and its pictures
// add theirs.
MeasurementLog told_circle(double noise) {
  LogOptions options;
  options.noise = noise;
  options.keyframes = 26;
  const MeasurementLog circle = circle_log(options);
  MeasurementLog log(circle.start());
  for (std::size_t k = 1; k < circle.size(); ++k) {
    log.add_keyframe(circle.arrival(k).step);
    for (const RelativePose& z : circle.arrival(k).registrations) {
      const Eigen::Vector3d sigma(kLoopSigmaM, 0.5 * kLoopSigmaM, kLoopSigmaRad);
      SharedErrors shared{{-Eigen::Matrix3d::Identity(), sigma},
                          {planar_rotation(z.motion.theta), sigma},
                          0.5 * z.covariance()};
      shared.from.G(0, 2) = z.motion.y;
      shared.from.G(1, 2) = -z.motion.x;
      RelativePose told = RelativePose::from_covariance(z.from, z.to, z.motion, shared.total());
      told.shared = std::make_shared<const SharedErrors>(shared);
      log.add_registration(told);
    }
  }
  return log;
}

MeasurementLog untold(const MeasurementLog& log) {
  MeasurementLog result(log.start());
  for (std::size_t k = 1; k < log.size(); ++k) {
    result.add_keyframe(log.arrival(k).step);
    for (RelativePose z : log.arrival(k).registrations) {
      z.shared = nullptr;
      result.add_registration(z);
    }
  }
  return result;
}

using ExpectCovariance = void(std::size_t k, const Eigen::Matrix3d& found,
                              const Eigen::Matrix3d& joint);

// At the truth, beside the joint least squares.
void expect_beside_joint(Subject& subject, ExpectCovariance* expect_one) {
  const MeasurementLog log = told_circle(0.0);
  const GuardedEstimator& estimator = subject.solved(log);
  const NaiveLeastSquares joint = least_squares(log, 1, {}, RegistrationErrors::shared);
  expect_poses(estimator, joint.poses, 1e-9);
  for (std::size_t k = 1; k < log.size(); ++k) {
    expect_one(k, covariance_of(estimator, k), joint.marginal(k));
  }
}

void expect_equal(std::size_t k, const Eigen::Matrix3d& found, const Eigen::Matrix3d& joint) {
  expect_covariance(numbered("covariance of keyframe", k), found, joint, 1e-7);
}

// No unbiased linear estimate has a smaller covariance than the joint least squares (Gauss and
// Markov): what is smaller is not honest.
void expect_no_less(std::size_t k, const Eigen::Matrix3d& found, const Eigen::Matrix3d& joint) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> more(found - joint, Eigen::EigenvaluesOnly);
  expect_at_least(numbered("least eigenvalue above the joint covariance, of keyframe", k),
                  more.eigenvalues()[0] / joint.norm(), -1e-7);
}

// One that estimates them, one that does not ask, and one that considers them.
void shared_errors(Subject& subject) {
  const MeasurementLog log = told_circle(1.0);
  const GuardedEstimator& estimator = subject.solved(log);
  if (estimator.estimates_shared_errors()) return expect_beside_joint(subject, expect_equal);
  const std::vector<Pose> told = poses_of(estimator);
  if (poses_of(subject.solved(untold(log))) != told) expect_beside_joint(subject, expect_no_less);
}

}  // namespace

std::vector<Clause> shared_clauses() {
  return {{{"shared_errors",
            "errors that registrations share are estimated, with the covariances of the joint "
            "least squares; or considered, with no smaller ones; or they are not asked for, and "
            "the log is as if it told nothing"},
           shared_errors}};
}

}  // namespace fathom::conformance
