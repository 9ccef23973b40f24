#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "fathom/geometry/covariance.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// A measurement of a keyframe's pose in the world: a compass heading, a position fix, or both.
///
/// `information` Ω weighs the residual e = t2v(A⁻¹ · X_k), heading wrapped, so it is given in the
/// axes of A: g2o's EDGE_PRIOR_SE2. It is positive semi-definite: what is not measured has no
/// information. F gains eᵀ Ω e. As A⁻¹ X_k = Z⁻¹ X_0⁻¹ X_k with Z = X_0⁻¹ A, it is the measurement
/// of a motion from a frame X_0 that is known exactly (docs/absolute_measurements.md).
struct AbsolutePose {
  std::size_t keyframe = 0;
  Pose pose;  ///< A, world frame
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();

  /// A heading alone.
  static AbsolutePose heading(std::size_t keyframe, double heading_rad, double sigma_rad);
  /// A position alone, world axes: A has heading 0. `covariance` in m², positive definite.
  static AbsolutePose position(std::size_t keyframe, const Eigen::Vector2d& position,
                               const Eigen::Matrix2d& covariance);
  /// All three; `covariance` of (x, y, θ), world axes, positive definite.
  static AbsolutePose from_covariance(std::size_t keyframe, const Pose& pose,
                                      const Eigen::Matrix3d& covariance);
};

/// e = t2v(A⁻¹ · X), heading wrapped, and its 3×3 Jacobian with respect to (x, y, θ) of X.
Eigen::Vector3d residual(const AbsolutePose& measurement, const Pose& X,
                         Eigen::Matrix3d* residual_X = nullptr);

/// eᵀ Ω e of one measurement.
double chi2(const AbsolutePose& measurement, const Pose& X);

/// A position fix of a point that is fixed to the body, `lever` in its frame (an antenna), taken
/// when the body was at X_k ⊕ `motion`, keyframe k the one before: as a measurement of X_k. The
/// motion's covariance adds to that of the fix (world axes, m²).
///
/// The position of the point hangs on the heading of the keyframe, so that the result informs on
/// position and heading together: first order at `heading_rad`, a heading of keyframe k that has to
/// be known to a part of σ over the distance |motion ⊕ lever|. Rank 2.
AbsolutePose fix_of_point(std::size_t keyframe, const Eigen::Vector2d& position,
                          const Eigen::Matrix2d& covariance, const UncertainPose& motion,
                          const Eigen::Vector2d& lever, double heading_rad);

/// A heading measured when the body was at X_k ⊕ `motion`, as a measurement of X_k.
AbsolutePose heading_after(std::size_t keyframe, double heading_rad, double sigma_rad,
                           const UncertainPose& motion);

/// Where keyframe 0 is, and how well that is known.
struct StartPose {
  StartPose() = default;
  /// Fixed.
  StartPose(const Pose& at) : pose(at) {}  // NOLINT(google-explicit-constructor)

  Pose pose;
  /// Of (x, y, θ), world axes; positive definite, or zero: keyframe 0 is fixed at `pose`.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  /// Nothing is known of keyframe 0 but what absolute measurements say; `pose` is where to begin,
  /// and `covariance` is not looked at.
  bool is_free = false;

  /// Whether keyframe 0 is held at `pose`.
  bool is_fixed() const { return !is_free && covariance.isZero(0.0); }
  /// What is known of keyframe 0 as a measurement of it; without information if it is fixed or
  /// free.
  AbsolutePose measurement() const;
};

}  // namespace fathom
