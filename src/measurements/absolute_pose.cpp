#include "fathom/measurements/absolute_pose.hpp"

#include <cmath>

#include <Eigen/LU>

namespace fathom {
AbsolutePose AbsolutePose::heading(std::size_t keyframe, double heading_rad, double sigma_rad) {
  AbsolutePose measurement{keyframe, {0.0, 0.0, wrap_angle(heading_rad)}};
  measurement.information(2, 2) = 1.0 / (sigma_rad * sigma_rad);
  return measurement;
}

AbsolutePose AbsolutePose::position(std::size_t keyframe, const Eigen::Vector2d& position,
                                    const Eigen::Matrix2d& covariance) {
  AbsolutePose measurement{keyframe, {position.x(), position.y(), 0.0}};
  const Eigen::Matrix2d inverse = covariance.inverse();
  measurement.information.topLeftCorner<2, 2>() = 0.5 * (inverse + inverse.transpose());
  return measurement;
}

AbsolutePose AbsolutePose::from_covariance(std::size_t keyframe, const Pose& pose,
                                           const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d to_own_axes = planar_rotation(pose.theta).transpose();
  return {keyframe, pose, symmetric_inverse(transport(to_own_axes, covariance))};
}

Eigen::Vector3d residual(const AbsolutePose& measurement, const Pose& X,
                         Eigen::Matrix3d* residual_X) {
  return between(measurement.pose, X, nullptr, residual_X).vector();
}

double chi2(const AbsolutePose& measurement, const Pose& X) {
  const Eigen::Vector3d e = residual(measurement, X);
  return e.dot(measurement.information * e);
}

// The point is at p + Rot(θ) b with b = motion ⊕ lever. With J = [I  Rot'(θ) b] about A = (x_A −
// Rot(θ) b, θ) the information in world axes is Jᵀ C⁻¹ J.
AbsolutePose fix_of_point(std::size_t keyframe, const Eigen::Vector2d& position,
                          const Eigen::Matrix2d& covariance, const UncertainPose& motion,
                          const Eigen::Vector2d& lever, double heading_rad) {
  const Eigen::Matrix2d R = rotation(heading_rad);
  const Eigen::Vector2d arm = R * rotation(motion.mean.theta) * lever;
  const Eigen::Vector2d reach = R * motion.mean.position() + arm;
  Eigen::Matrix<double, 2, 3> point_motion;
  point_motion << R, Eigen::Vector2d(-arm.y(), arm.x());
  const Eigen::Matrix2d C =
      covariance + point_motion * motion.covariance * point_motion.transpose();
  const Eigen::Matrix2d inverse = C.inverse();
  Eigen::Matrix<double, 2, 3> J;
  J << Eigen::Matrix2d::Identity(), Eigen::Vector2d(-reach.y(), reach.x());
  const Eigen::Matrix3d world = J.transpose() * (0.5 * (inverse + inverse.transpose())) * J;
  const Eigen::Vector2d p = position - reach;
  return {keyframe,
          {p.x(), p.y(), wrap_angle(heading_rad)},
          transport(planar_rotation(heading_rad).transpose(), world)};
}

AbsolutePose heading_after(std::size_t keyframe, double heading_rad, double sigma_rad,
                           const UncertainPose& motion) {
  const double variance = sigma_rad * sigma_rad + motion.covariance(2, 2);
  return AbsolutePose::heading(keyframe, heading_rad - motion.mean.theta, std::sqrt(variance));
}

AbsolutePose StartPose::measurement() const {
  if (is_free || is_fixed()) return {0, pose};
  return AbsolutePose::from_covariance(0, pose, covariance);
}

}  // namespace fathom
