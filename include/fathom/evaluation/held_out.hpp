#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// Loops that an estimate was made without (draw_held_out), and that estimate.
struct HeldOutLoops {
  std::vector<RelativePose> loops;
  std::vector<Pose> estimate;  ///< of the keyframes
  /// Places of the loops whose estimated motion has a covariance, and those covariances, as of
  /// JudgedMotions. Empty where they cannot be had.
  std::vector<std::size_t> tested;
  std::vector<Eigen::Matrix3d> covariances;
};

/// What estimate and loops are apart.
struct HeldOutErrors {
  double position_median_m = 0.0;
  double position_rmse_m = 0.0;
  double heading_median_rad = 0.0;
  double heading_rmse_rad = 0.0;
  std::optional<double> mean_nis;  ///< 3 expected, above: overconfident
};

/// With z a loop of i → j and h = ⊖X_i ⊕ X_j of the estimate, the error is e = ⊖z ⊕ h, the residual
/// of F. As z has no part in the estimate, its error and that of h are independent:
///
///     NIS = νᵀ (P + R)⁻¹ ν,   ν = z − h = −D e,   D = diag(Rot(θ_z), 1)
///
/// with P the covariance of h and R that of ν, both in the axes of i. It is eᵀ (Dᵀ P D + Ω⁻¹)⁻¹ e.
///
/// Nothing where there is no loop or a pose is not finite; no NIS without covariances, or where
/// P + R is not positive definite: no loop is ever left out. Throws InputError where lists that
/// belong together differ in length.
std::optional<HeldOutErrors> held_out_errors(const HeldOutLoops& held_out);

}  // namespace fathom
