#pragma once

#include <Eigen/Core>

namespace fathom {

/// What the errors n of one picture do to a registration of it: z moves by G n. n is a draw a
/// picture, the same in all its registrations, of zero mean, with independent parts; those of a
/// picture of the floor are altitude (m), roll and pitch (rad), as assumed less as they were.
struct PictureErrors {
  Eigen::Matrix3d G = Eigen::Matrix3d::Zero();      ///< ∂z/∂n, axes of `from`
  Eigen::Vector3d sigma = Eigen::Vector3d::Zero();  ///< standard deviations of n

  /// ∂z/∂n for n in units of σ, so that its prior is the identity.
  Eigen::Matrix3d scaled() const { return G * sigma.asDiagonal(); }

  bool operator==(const PictureErrors&) const = default;
};

/// A registration's errors apart: z = h(X_from, X_to) + G_from n_from + G_to n_to + ν, Cov ν = own.
/// What an estimator that does not ask is told is the total() as if registrations were independent
/// (docs/shared_errors.md).
struct SharedErrors {
  PictureErrors from;
  PictureErrors to;
  Eigen::Matrix3d own = Eigen::Matrix3d::Zero();  ///< of (x, y, θ), axes of `from`; pos. definite

  /// G_from Σ G_fromᵀ + G_to Σ G_toᵀ + own.
  Eigen::Matrix3d total() const;
  /// Whether any error of a picture moves it.
  bool is_shared() const { return !from.scaled().isZero(0.0) || !to.scaled().isZero(0.0); }
  /// Of the same measurement from its other end, J = ∂(⊖z)/∂z.
  SharedErrors reversed(const Eigen::Matrix3d& J) const;

  bool operator==(const SharedErrors&) const = default;
};

}  // namespace fathom
