#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/shared_errors.hpp"

namespace fathom {

/// A measured motion between two keyframes: z is the pose of keyframe `to` in the frame of `from`.
/// A dead-reckoning step (odometry edge) and a registration (loop edge) are both one of these.
///
/// Two equivalent forms of its uncertainty (docs/conventions.md):
/// - `information` Ω weighs the residual e = t2v(Z⁻¹ · X_from⁻¹ · X_to), in the frame of `to` as
///   measured, as g2o's EDGE_SE2 has it. It is the one that is stored: F is Σ eᵀ Ω e on the edges
///   as written.
/// - `covariance()` R = Rot(θ_z) Ω⁻¹ Rot(θ_z)ᵀ is that of ν = z − h(x), in the frame of `from`,
///   which is what a filter uses and what registration gives.
struct RelativePose {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose motion;
  Eigen::Matrix3d information = Eigen::Matrix3d::Identity();
  /// Matches that support a registration; none for dead reckoning, or where not known.
  std::optional<int> inliers;
  /// Of a step: nothing was measured. `motion` is a guess, and `information` that of a declared,
  /// wide covariance: what a filter begins with. F does not count it.
  bool is_hole = false;
  /// Of a registration: its own covariance stands so many times for what it is of it alone, because
  /// other registrations of its pictures have keypoints in common with it (count_keypoints_once).
  double repeats = 1.0;
  /// Of a registration: its errors apart, where that is known.
  /// `information` is that of their total(), for whoever does not ask.
  std::shared_ptr<const SharedErrors> shared = nullptr;

  /// Of a covariance of ν; it must be positive definite.
  static RelativePose from_covariance(std::size_t from, std::size_t to, const Pose& motion,
                                      const Eigen::Matrix3d& covariance);

  Eigen::Matrix3d covariance() const;

  /// With the covariance that it has of itself: what its error against the truth is judged by.
  RelativePose alone() const;
  /// With its own covariance times `factor`, as one of several that have keypoints in common.
  RelativePose repeated(double factor) const;

  /// The later of its two keyframes: a registration arrives with it.
  std::size_t newest() const { return from > to ? from : to; }

  /// The same measurement from its other end: ⊖z, covariance propagated to first order.
  RelativePose reversed() const;
  /// The same measurement with from < to: as it is, or reversed.
  RelativePose forward() const;
};

/// A registration that tells its errors apart as it is left when what those of its pictures do to
/// it, G_from n_from + G_to n_to, is taken out: of its own covariance. What a gate tests.
RelativePose without_shared(const RelativePose& z, const Eigen::Vector3d& error);

/// e = t2v(Z⁻¹ · A⁻¹ · B) for the poses A of `from` and B of `to`; heading wrapped. Optional 3×3
/// Jacobians with respect to (x, y, θ) of A and B.
Eigen::Vector3d residual(const Pose& motion, const Pose& A, const Pose& B,
                         Eigen::Matrix3d* residual_A = nullptr,
                         Eigen::Matrix3d* residual_B = nullptr);

/// eᵀ Ω e of one measurement.
double chi2(const RelativePose& measurement, const Pose& A, const Pose& B);

}  // namespace fathom
