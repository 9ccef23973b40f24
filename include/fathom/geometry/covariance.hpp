#pragma once

#include <span>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// A pose or motion with the 3×3 covariance of its (x, y, θ): additive perturbations, in the axes
/// that x and y are given in; m², m·rad, rad².
struct UncertainPose {
  Pose mean;
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

/// X ⊕ Y of independent X and Y, first order.
UncertainPose compose(const UncertainPose& X, const UncertainPose& Y);

/// ⊖X, first order.
UncertainPose inverse(const UncertainPose& X);

/// ⊖A ⊕ B of independent A and B, first order.
UncertainPose between(const UncertainPose& A, const UncertainPose& B);

/// The joint covariance of two poses by its blocks; the fourth is the transpose of `cross`.
struct PairCovariance {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d B = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d cross = Eigen::Matrix3d::Zero();  ///< rows of A, columns of B
};

/// ⊖A ⊕ B of two poses that are correlated, first order: H_A C_A H_Aᵀ + H_B C_B H_Bᵀ and what the
/// correlation adds, H_A C_AB H_Bᵀ and its transpose. With the covariance of a measurement of the
/// motion added it is that of the innovation.
UncertainPose between(const Pose& A, const Pose& B, const PairCovariance& covariance);

/// The composition of independent motions in their order: the pose of the last frame in the first.
/// Of none: the exact identity.
UncertainPose compose_chain(std::span<const UncertainPose> motions);

/// The part of a motion between two shares of it, 0 <= from < to <= 1, at constant velocity in the
/// axes of its start: in the frame at `from_share`, with its share of the covariance. The whole is
/// the motion itself, to the last bit.
UncertainPose part_of(const UncertainPose& motion, double from_share, double to_share);

/// J C Jᵀ, the covariance propagated through J; symmetric to the last bit.
Eigen::Matrix3d transport(const Eigen::Matrix3d& J, const Eigen::Matrix3d& covariance);

/// Whether a symmetric matrix is positive definite whatever the units of its rows: it is scaled to
/// a unit diagonal first, so that headings known to 1e-8 rad beside metres do no harm. NaN is not.
bool is_positive_definite(const Eigen::Matrix3d& matrix);

/// Likewise positive semi-definite: no eigenvalue of the scaled matrix is negative but by rounding,
/// and a row without a diagonal element is zero.
bool is_positive_semidefinite(const Eigen::Matrix3d& matrix);

/// What a positive semi-definite information matrix Ω measures, in independent rows:
/// Ω = rowsᵀ diag(1 / variances) rows. Rows beyond the rank are zero, and have variance 1.
struct InformationRows {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Zero();
  Eigen::Vector3d variances = Eigen::Vector3d::Ones();
  int rank = 0;
};

InformationRows rows_of(const Eigen::Matrix3d& information);

/// Independent rows of a positive semi-definite information matrix.
int rank_of(const Eigen::Matrix3d& information);

/// The inverse of a positive definite matrix, symmetric to the last bit.
Eigen::Matrix3d symmetric_inverse(const Eigen::Matrix3d& matrix);

}  // namespace fathom
