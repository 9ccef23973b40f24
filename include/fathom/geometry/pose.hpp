#pragma once

#include <Eigen/Core>

namespace fathom {

/// Wraps an angle to (−π, π]. NaN stays NaN.
double wrap_angle(double angle_rad);

/// Rot(θ): turns the axes of a frame at heading θ into those of its parent.
Eigen::Matrix2d rotation(double theta_rad);

/// Rot(θ) on (x, y), the identity on the heading.
Eigen::Matrix3d planar_rotation(double theta_rad);

/// A planar pose (x, y, θ), or, equally, a motion: the pose of one frame in another. Metres and
/// radians; x forward, y to port, θ counter-clockwise seen from above.
struct Pose {
  double x = 0.0;
  double y = 0.0;
  double theta = 0.0;

  Eigen::Vector2d position() const { return {x, y}; }
  Eigen::Vector3d vector() const { return {x, y, theta}; }
  static Pose from_vector(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

  bool operator==(const Pose&) const = default;
};

bool is_finite(const Pose& pose);

/// X ⊕ Y, the pose Y given in the frame X, expressed in X's parent (Smith, Self, Cheeseman,
/// *Estimating Uncertain Spatial Relationships in Robotics*, 1990, section 3.2). The heading is
/// wrapped.
///
/// The optional Jacobians are 3×3 derivatives of (x, y, θ) of the result with respect to (x, y, θ)
/// of the operand: plain additive perturbation, heading differences wrapped.
Pose compose(const Pose& X, const Pose& Y, Eigen::Matrix3d* result_X = nullptr,
             Eigen::Matrix3d* result_Y = nullptr);

/// ⊖X: the parent's pose in the frame X, so that X ⊕ (⊖X) = 0.
Pose inverse(const Pose& X, Eigen::Matrix3d* result_X = nullptr);

/// ⊖A ⊕ B: the motion from A to B, that is, the pose of B in the frame A.
Pose between(const Pose& A, const Pose& B, Eigen::Matrix3d* result_A = nullptr,
             Eigen::Matrix3d* result_B = nullptr);

/// X ⊕ p for a point: p given in the frame X, expressed in X's parent.
Eigen::Vector2d transform(const Pose& X, const Eigen::Vector2d& point);

}  // namespace fathom
