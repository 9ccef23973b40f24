#include "fathom/measurements/relative_pose.hpp"

#include "fathom/geometry/covariance.hpp"

namespace fathom {
RelativePose RelativePose::from_covariance(std::size_t from, std::size_t to, const Pose& motion,
                                           const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d R = planar_rotation(motion.theta);
  RelativePose measurement;
  measurement.from = from;
  measurement.to = to;
  measurement.motion = motion;
  measurement.information = symmetric_inverse(transport(R.transpose(), covariance));
  return measurement;
}

Eigen::Matrix3d RelativePose::covariance() const {
  return transport(planar_rotation(motion.theta), symmetric_inverse(information));
}

RelativePose RelativePose::reversed() const {
  const UncertainPose back = inverse(UncertainPose{motion, covariance()});
  RelativePose measurement = from_covariance(to, from, back.mean, back.covariance);
  measurement.inliers = inliers;
  measurement.is_hole = is_hole;
  measurement.repeats = repeats;
  if (shared) {
    Eigen::Matrix3d J;
    inverse(motion, &J);
    measurement.shared = std::make_shared<const SharedErrors>(shared->reversed(J));
  }
  return measurement;
}

RelativePose RelativePose::alone() const {
  return repeats == 1.0 ? *this : repeated(1.0 / repeats);
}

RelativePose RelativePose::repeated(double factor) const {
  RelativePose measurement = *this;
  measurement.repeats *= factor;
  if (shared) {
    SharedErrors parts = *shared;
    parts.own *= factor;
    measurement.information = from_covariance(from, to, motion, parts.total()).information;
    measurement.shared = std::make_shared<const SharedErrors>(parts);
  } else {
    measurement.information /= factor;
  }
  return measurement;
}

RelativePose RelativePose::forward() const {
  return from <= to ? *this : reversed();
}

RelativePose without_shared(const RelativePose& z, const Eigen::Vector3d& error) {
  const Eigen::Vector3d left = z.motion.vector() - error;
  RelativePose apart = RelativePose::from_covariance(
      z.from, z.to, {left.x(), left.y(), wrap_angle(left.z())}, z.shared->own);
  apart.shared = z.shared;
  apart.repeats = z.repeats;
  return apart;
}

Eigen::Vector3d residual(const Pose& motion, const Pose& A, const Pose& B,
                         Eigen::Matrix3d* residual_A, Eigen::Matrix3d* residual_B) {
  Eigen::Matrix3d error_prediction;
  const Pose prediction = between(A, B, residual_A, residual_B);
  const Pose error = between(motion, prediction, nullptr, &error_prediction);
  if (residual_A != nullptr) *residual_A = error_prediction * *residual_A;
  if (residual_B != nullptr) *residual_B = error_prediction * *residual_B;
  return error.vector();
}

double chi2(const RelativePose& measurement, const Pose& A, const Pose& B) {
  const Eigen::Vector3d e = residual(measurement.motion, A, B);
  return e.dot(measurement.information * e);
}

}  // namespace fathom
