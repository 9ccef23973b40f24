// The Kalman update of what an arrival's loops measure, stacked.

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "estimators/support/filter/delayed_state.hpp"

namespace fathom::filter {

/// Registrations of one update, stacked.
struct DelayedStateFilter::Stack {
  Eigen::MatrixXd PHt;
  Eigen::VectorXd nu;
  Eigen::MatrixXd HPHt;
  Eigen::MatrixXd S;
};

Eigen::MatrixX3d DelayedStateFilter::covariance_times_transposed(
    const Innovation& innovation) const {
  Eigen::MatrixX3d PHt = P_.column(block_of(innovation.to)) * innovation.H_to.transpose();
  if (innovation.from > 0) {
    PHt += P_.column(block_of(innovation.from)) * innovation.H_from.transpose();
  }
  if (innovation.is_told) {
    PHt += P_.column(errors_.block_of(innovation.from)) * innovation.G_from.transpose();
    PHt += P_.column(errors_.block_of(innovation.to)) * innovation.G_to.transpose();
  }
  return PHt;
}

// H P Hᵀ of the stacked registrations, from P Hᵀ.
Eigen::MatrixXd DelayedStateFilter::projected(std::span<const Innovation> stack,
                                              const Eigen::MatrixXd& PHt) const {
  Eigen::MatrixXd HPHt(PHt.cols(), PHt.cols());
  for (std::size_t j = 0; j < stack.size(); ++j) {
    const Innovation& z = stack[j];
    const auto row = static_cast<Eigen::Index>(3 * j);
    HPHt.middleRows<3>(row) = z.H_to * PHt.middleRows<3>(3 * block_of(z.to));
    if (z.from > 0) {
      HPHt.middleRows<3>(row) += z.H_from * PHt.middleRows<3>(3 * block_of(z.from));
    }
    if (z.is_told) {
      HPHt.middleRows<3>(row) += z.G_from * PHt.middleRows<3>(3 * errors_.block_of(z.from));
      HPHt.middleRows<3>(row) += z.G_to * PHt.middleRows<3>(3 * errors_.block_of(z.to));
    }
  }
  return HPHt;
}

DelayedStateFilter::Stack DelayedStateFilter::stack(std::span<const Innovation> loops) const {
  const auto rows = static_cast<Eigen::Index>(3 * loops.size());
  Stack stack;
  stack.PHt.resize(P_.size(), rows);
  stack.nu.resize(rows);
  for (Eigen::Index j = 0; j < rows; j += 3) {
    const Innovation& innovation = loops[static_cast<std::size_t>(j / 3)];
    stack.PHt.middleCols<3>(j) = covariance_times_transposed(innovation);
    stack.nu.segment<3>(j) = innovation.nu;
  }
  stack.HPHt = projected(loops, stack.PHt);
  stack.S = stack.HPHt;
  for (Eigen::Index j = 0; j < rows; j += 3) {
    stack.S.block<3, 3>(j, j) += loops[static_cast<std::size_t>(j / 3)].rows.R;
  }
  return stack;
}

// Drops those of the accepted that do not go together with the others.
void DelayedStateFilter::gate_together(std::vector<Innovation>& accepted,
                                       UpdateReport& report) const {
  if (!gate_.is_joint_on() || accepted.empty()) return;
  const Stack all = stack(accepted);
  std::vector<int> ranks;
  ranks.reserve(accepted.size());
  for (const Innovation& z : accepted) ranks.push_back(z.rows.rank);
  const std::vector<bool> together =
      gate_.pass_together(all.nu, all.S, std::vector<bool>(accepted.size(), true), ranks);
  std::vector<Innovation> kept;
  std::size_t next = 0;
  for (LoopDecision& loop : report.loops) {
    if (loop.fate != LoopFate::used) continue;
    loop.fate = fate_of(together[next]);
    if (together[next]) kept.push_back(accepted[next]);
    ++next;
  }
  accepted = std::move(kept);
}

Outcome DelayedStateFilter::update(std::span<const Innovation> accepted) {
  const auto& [PHt, nu, HPHt, S] = stack(accepted);
  double prior_cost = 0.0;
  for (const Innovation& z : accepted) {
    prior_cost += normalised_innovation_squared(z.nu, z.rows.R);
  }
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  if (!nu.allFinite() || llt.info() != Eigen::Success) return Outcome::numerical_failure;
  const Eigen::VectorXd lambda = llt.solve(nu);
  const Eigen::VectorXd dx = PHt * lambda;
  // V = P Hᵀ L⁻ᵀ.
  Eigen::MatrixXd V = PHt;
  llt.matrixU().solveInPlace<Eigen::OnTheRight>(V);
  if (!dx.allFinite() || !V.allFinite()) return Outcome::numerical_failure;

  const std::vector<Pose> before = poses_;
  const PictureErrorStates errors_before = errors_;
  correct(dx);
  // dxᵀ P⁻¹ dx = λᵀ H P Hᵀ λ, so the cost of the update needs no inverse of P. It is that of poses
  // and n together: of n that are only considered, too, as the gain of the poses supposes.
  double cost = lambda.dot(HPHt * lambda);
  for (const Innovation& z : accepted) {
    cost += normalised_innovation_squared(innovation_of(z), z.rows.R);
  }
  const bool is_good = cost <= divergence_factor_ * std::max(prior_cost, 1.0);
  if (!is_good) poses_ = before;
  if (!is_good || model_ == SharedErrorModel::consider) errors_ = errors_before;
  if (!is_good) return std::isfinite(cost) ? Outcome::diverged : Outcome::numerical_failure;
  if (model_ == SharedErrorModel::consider && !errors_.blocks().empty()) {
    P_.downdate_but(errors_.blocks(), V);
  } else {
    P_.downdate(V);
  }
  return Outcome::converged;
}

void DelayedStateFilter::correct(const Eigen::VectorXd& dx) {
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    poses_[k] = corrected(poses_[k], dx.segment<3>(3 * block_of(k)));
  }
  errors_.correct(dx);
}

}  // namespace fathom::filter
