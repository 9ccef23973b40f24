#include "estimators/support/filter/delayed_state.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Cholesky>

#include "fathom/estimation/precision.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::filter {

/// Registrations of one update, stacked.
struct DelayedStateFilter::Stack {
  Eigen::MatrixXd PHt;
  Eigen::VectorXd nu;
  Eigen::MatrixXd HPHt;
  Eigen::MatrixXd S;
};

void DelayedStateOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "linearisations of one update at most; an EKF always makes one");
  table.real("tolerance", tolerance, Range::positive(), "m, rad",
             "for estimators that iterate; of no effect here");
  table.real("divergence_factor", divergence_factor, Range::at_least(1.0), "",
             "an update has diverged at so many times the cost of leaving the state alone");
  gate.describe(table);
  gate.describe_joint(table);
}

DelayedStateFilter::DelayedStateFilter(const EstimatorSetup& setup,
                                       const DelayedStateOptions& options)
    : divergence_factor_(options.divergence_factor),
      gate_(options.gate),
      poses_{setup.start.pose} {}

Pose DelayedStateFilter::corrected(const Pose& pose, const Eigen::Vector3d& error) const {
  const Eigen::Vector3d moved = pose.vector() + error;
  return {moved.x(), moved.y(), wrap_angle(moved.z())};
}

// A turn of X_n moves the next pose about it.
Eigen::Matrix3d DelayedStateFilter::step_jacobian(std::size_t n, const Pose& next) const {
  const Pose last = linearised_at(n);
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topRightCorner<2, 1>() << -(next.y - last.y), next.x - last.x;
  return J;
}

void DelayedStateFilter::add_keyframe(const RelativePose& step) {
  const RelativePose u = step.forward();
  const std::size_t last = poses_.size() - 1;
  Eigen::Matrix3d J_last;
  Eigen::Matrix3d J_motion;
  const Pose next = compose(poses_.back(), u.motion, &J_last, &J_motion);
  if (linearised_at(last) != poses_.back()) J_last = step_jacobian(last, next);
  Eigen::Matrix3d added = transport(J_motion, u.covariance());
  const bool is_open = is_open_hole(step);
  if (is_open) {
    const Eigen::Matrix3d of_last = *covariance(last);
    floating_.push_back({poses_.size(), transport(J_last, of_last) + added});
  }
  poses_.push_back(next);
  note_added();
  part_of_.push_back(is_open ? floating_.size() : part_of_.back());
  if (is_open) return P_.append(Eigen::Matrix3d::Zero());
  if (const auto G = world_from_error(last + 1)) {
    const Eigen::Matrix3d error_from_world = inverse_of(*G);
    added = transport(error_from_world, added);
    J_last = error_from_world * J_last * world_from_error(last).value();
  }
  if (last == 0) return P_.append(added);
  const Eigen::Matrix3Xd cross = J_last * P_.column(block_of(last)).transpose();
  P_.append(cross, transport(J_last, P_.block(block_of(last), block_of(last))) + added);
}

Eigen::Vector3d DelayedStateFilter::innovation_of(const Innovation& z) const {
  Eigen::Vector3d nu = z.motion.vector() - between(poses_[z.from], poses_[z.to]).vector();
  nu.z() = wrap_angle(nu.z());
  return z.rows.is_whole() ? nu : z.rows.C * nu;
}

DelayedStateFilter::Innovation DelayedStateFilter::innovate(const RelativePose& z) const {
  Innovation innovation;
  innovation.from = z.from;
  innovation.to = z.to;
  innovation.motion = z.motion;
  innovation.rows = loop_rows(z);
  between(linearised_at(z.from), linearised_at(z.to), &innovation.H_from, &innovation.H_to);
  innovation.nu = innovation_of(innovation);
  if (!innovation.rows.is_whole()) {
    innovation.H_from = innovation.rows.C * innovation.H_from;
    innovation.H_to = innovation.rows.C * innovation.H_to;
  }
  if (const auto G = world_from_error(z.from)) innovation.H_from *= *G;
  if (const auto G = world_from_error(z.to)) innovation.H_to *= *G;
  return innovation;
}

Eigen::MatrixX3d DelayedStateFilter::covariance_times_transposed(
    const Innovation& innovation) const {
  Eigen::MatrixX3d PHt = P_.column(block_of(innovation.to)) * innovation.H_to.transpose();
  if (innovation.from > 0) {
    PHt += P_.column(block_of(innovation.from)) * innovation.H_from.transpose();
  }
  return PHt;
}

// Each by itself.
LoopDecision DelayedStateFilter::decide(const Innovation& z) const {
  Eigen::Matrix3d S = projected(std::span(&z, 1), covariance_times_transposed(z)) + z.rows.R;
  if (part_of_[z.from] != part_of_[z.to]) {
    const auto spread = [&](const Eigen::Matrix3d& H, std::size_t k) {
      const auto G = world_from_error(k);
      return transport(G ? (H * inverse_of(*G)).eval() : H, spread_of(k, k));
    };
    S += spread(z.H_from, z.from) + spread(z.H_to, z.to);
  }
  const double nis = normalised_innovation_squared(z.nu, S);
  return {z.from, z.to, fate_of(!gate_.is_on() || gate_.passes(nis, z.rows.rank)), nis};
}

UpdateReport DelayedStateFilter::close_loops(std::span<const RelativePose> registrations) {
  for (const RelativePose& z : registrations) {
    if (part_of_[z.from] == part_of_[z.to]) continue;
    settle(part_of_[z.from]);
    settle(part_of_[z.to]);
  }
  UpdateReport report;
  std::vector<Innovation> accepted;
  for (const RelativePose& registration : registrations) {
    const Innovation innovation = innovate(registration.forward());
    const LoopDecision decision = decide(innovation);
    report.loops.push_back({registration.from, registration.to, decision.fate, decision.nis});
    if (decision.fate == LoopFate::used) accepted.push_back(innovation);
  }
  if (!has_finite_nis(report) || !are_resolved(*this, registrations)) {
    lose_all(report, Outcome::numerical_failure);
    return report;
  }
  gate_together(accepted, report);
  if (accepted.empty()) return report;
  report.iterations = 1;
  report.outcome = update(accepted);
  if (!is_done(report.outcome)) lose_all(report, report.outcome);
  return report;
}

// H P Hᵀ of the stacked registrations, from P Hᵀ.
Eigen::MatrixXd DelayedStateFilter::projected(std::span<const Innovation> stack,
                                              const Eigen::MatrixXd& PHt) {
  Eigen::MatrixXd HPHt(PHt.cols(), PHt.cols());
  for (std::size_t j = 0; j < stack.size(); ++j) {
    const Innovation& z = stack[j];
    const auto row = static_cast<Eigen::Index>(3 * j);
    HPHt.middleRows<3>(row) = z.H_to * PHt.middleRows<3>(3 * block_of(z.to));
    if (z.from > 0) {
      HPHt.middleRows<3>(row) += z.H_from * PHt.middleRows<3>(3 * block_of(z.from));
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
  for (std::size_t k = 1; k < poses_.size(); ++k) {
    poses_[k] = corrected(poses_[k], dx.segment<3>(3 * block_of(k)));
  }
  // dxᵀ P⁻¹ dx = λᵀ H P Hᵀ λ, so the cost of the update needs no inverse of P.
  double cost = lambda.dot(HPHt * lambda);
  for (const Innovation& z : accepted) {
    cost += normalised_innovation_squared(innovation_of(z), z.rows.R);
  }
  if (!(cost <= divergence_factor_ * std::max(prior_cost, 1.0))) {
    poses_ = before;
    return std::isfinite(cost) ? Outcome::diverged : Outcome::numerical_failure;
  }
  P_.downdate(V);
  return Outcome::converged;
}

}  // namespace fathom::filter
