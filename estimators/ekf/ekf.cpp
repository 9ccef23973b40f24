#include "estimators/ekf/ekf.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <Eigen/Cholesky>

#include "fathom/estimation/precision.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

/// Registrations of one update, stacked.
struct Ekf::Stack {
  Eigen::MatrixXd PHt;
  Eigen::VectorXd nu;
  Eigen::MatrixXd HPHt;
  Eigen::MatrixXd S;
};

void EkfOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "linearisations of one update at most; an EKF always makes one");
  table.real("tolerance", tolerance, Range::positive(), "m, rad",
             "for estimators that iterate; of no effect here");
  table.real("divergence_factor", divergence_factor, Range::at_least(1.0), "",
             "an update has diverged at so many times the cost of leaving the state alone");
  gate.describe(table);
  gate.describe_joint(table);
}

Ekf::Ekf(const EstimatorSetup& setup, const EkfOptions& options)
    : divergence_factor_(options.divergence_factor),
      gate_(options.gate),
      poses_{setup.start.pose} {}

void Ekf::add_keyframe(const RelativePose& step) {
  const RelativePose u = step.forward();
  Eigen::Matrix3d J_last;
  Eigen::Matrix3d J_motion;
  const Pose next = compose(poses_.back(), u.motion, &J_last, &J_motion);
  const Eigen::Matrix3d added = transport(J_motion, u.covariance());
  if (is_open_hole(step)) {
    const Eigen::Matrix3d last = *covariance(poses_.size() - 1);
    floating_.push_back({poses_.size(), transport(J_last, last) + added});
    P_.append(Eigen::Matrix3d::Zero());
    poses_.push_back(next);
    part_of_.push_back(floating_.size());
    return;
  }
  part_of_.push_back(part_of_.back());
  if (poses_.size() == 1) {
    P_.append(added);
  } else {
    const Eigen::Matrix3Xd cross = J_last * P_.column(block_of(poses_.size() - 1)).transpose();
    P_.append(cross, transport(J_last,
                               P_.block(block_of(poses_.size() - 1), block_of(poses_.size() - 1))) +
                         added);
  }
  poses_.push_back(next);
}

Eigen::Vector3d Ekf::innovation_of(const Innovation& z) const {
  Eigen::Vector3d nu = z.motion.vector() - between(poses_[z.from], poses_[z.to]).vector();
  nu.z() = wrap_angle(nu.z());
  return z.rows.is_whole() ? nu : z.rows.C * nu;
}

Ekf::Innovation Ekf::innovate(const RelativePose& z) const {
  Innovation innovation;
  innovation.from = z.from;
  innovation.to = z.to;
  innovation.motion = z.motion;
  innovation.rows = loop_rows(z);
  between(poses_[z.from], poses_[z.to], &innovation.H_from, &innovation.H_to);
  innovation.nu = innovation_of(innovation);
  if (!innovation.rows.is_whole()) {
    innovation.H_from = innovation.rows.C * innovation.H_from;
    innovation.H_to = innovation.rows.C * innovation.H_to;
  }
  return innovation;
}

Eigen::MatrixX3d Ekf::covariance_times_transposed(const Innovation& innovation) const {
  Eigen::MatrixX3d PHt = P_.column(block_of(innovation.to)) * innovation.H_to.transpose();
  if (innovation.from > 0) {
    PHt += P_.column(block_of(innovation.from)) * innovation.H_from.transpose();
  }
  return PHt;
}

// Each by itself.
LoopDecision Ekf::decide(const Innovation& z) const {
  Eigen::Matrix3d S = projected(std::span(&z, 1), covariance_times_transposed(z)) + z.rows.R;
  if (part_of_[z.from] != part_of_[z.to]) {
    S += transport(z.H_from, spread_of(z.from, z.from)) + transport(z.H_to, spread_of(z.to, z.to));
  }
  const double nis = normalised_innovation_squared(z.nu, S);
  return {z.from, z.to, fate_of(!gate_.is_on() || gate_.passes(nis, z.rows.rank)), nis};
}

UpdateReport Ekf::close_loops(std::span<const RelativePose> registrations) {
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
Eigen::MatrixXd Ekf::projected(std::span<const Innovation> stack, const Eigen::MatrixXd& PHt) {
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

Ekf::Stack Ekf::stack(std::span<const Innovation> loops) const {
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
void Ekf::gate_together(std::vector<Innovation>& accepted, UpdateReport& report) const {
  if (!gate_.is_joint_on() || accepted.empty()) return;
  const Stack all = stack(accepted);
  std::vector<int> ranks;
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

Outcome Ekf::update(std::span<const Innovation> accepted) {
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
    const Eigen::Vector3d moved = poses_[k].vector() + dx.segment<3>(3 * block_of(k));
    poses_[k] = {moved.x(), moved.y(), wrap_angle(moved.z())};
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

EstimatorEntry ekf_entry() {
  EstimatorEntry entry = make_relative_entry<EkfOptions>(
      "ekf", "plain EKF on absolute keyframe poses (delayed state), one linearisation", false,
      [](const EstimatorSetup& setup, const EkfOptions& options) {
        return std::make_unique<Ekf>(setup, options);
      });
  entry.unused_options = {"max_iterations", "tolerance"};
  return entry;
}

}  // namespace fathom
