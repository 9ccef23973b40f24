#pragma once

#include "estimators/support/filter/delayed_state.hpp"

namespace fathom {

/// The delayed-state EKF with a right-invariant error (Barrau and Bonnabel, *The Invariant Extended
/// Kalman Filter as a Stable Observer*, IEEE Transactions on Automatic Control 62(4), 2017): with
/// X_k in SE(2), X_k = exp(ξ_k) X̂_k, ξ = (ξ_x, ξ_y, ξ_θ) a twist about node 0 in world axes. A
/// motion of the whole map is the same ξ of every pose, wherever the estimate is.
/// docs/estimators/invariant_ekf.md.
class InvariantEkf final : public filter::DelayedStateFilter {
 public:
  using DelayedStateFilter::DelayedStateFilter;

 protected:
  /// δθ = ξ_θ, δp = (ξ_x, ξ_y) + ξ_θ (−p_y, p_x), to first order.
  std::optional<Eigen::Matrix3d> world_from_error(std::size_t k) const override;
  /// exp(ξ) X̂.
  Pose corrected(const Pose& pose, const Eigen::Vector3d& error) const override;
};

/// The exponential of a twist (ρ_x, ρ_y, φ) of SE(2), as a pose: with a = sin φ / φ and
/// b = (1 − cos φ) / φ its position is (a ρ_x − b ρ_y, b ρ_x + a ρ_y).
Pose exponential(const Eigen::Vector3d& twist);

EstimatorEntry invariant_ekf_entry();

}  // namespace fathom
