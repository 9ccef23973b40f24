#include "estimators/support/filter/delayed_state.hpp"

#include <algorithm>

#include "fathom/estimation/precision.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::filter {

void DelayedStateOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "linearisations of one update at most; an EKF always makes one");
  table.real("tolerance", tolerance, Range::positive(), "m, rad",
             "for estimators that iterate; of no effect here");
  table.real("divergence_factor", divergence_factor, Range::at_least(1.0), "",
             "an update has diverged at so many times the cost of leaving the state alone");
  gate.describe(table);
  gate.describe_joint(table);
  shared_errors.describe_of_filter(table);
}

DelayedStateFilter::DelayedStateFilter(const EstimatorSetup& setup,
                                       const DelayedStateOptions& options)
    : divergence_factor_(options.divergence_factor),
      gate_(options.gate),
      model_(options.shared_errors.model),
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

void DelayedStateFilter::append(const Eigen::Matrix3Xd& cross, const Eigen::Matrix3d& covariance) {
  block_of_.push_back(P_.size() / 3);
  if (cross.cols() == 0) return P_.append(covariance);
  P_.append(cross, covariance);
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
  if (is_open) return append({}, Eigen::Matrix3d::Zero());
  if (const auto G = world_from_error(last + 1)) {
    const Eigen::Matrix3d error_from_world = inverse_of(*G);
    added = transport(error_from_world, added);
    J_last = error_from_world * J_last * world_from_error(last).value();
  }
  if (last == 0) return append({}, added);
  const Eigen::Matrix3Xd cross = J_last * P_.column(block_of(last)).transpose();
  append(cross, transport(J_last, P_.block(block_of(last), block_of(last))) + added);
}

void DelayedStateFilter::admit(const RelativePose& z) {
  if (!is_told(z)) return;
  for (const std::size_t k : {z.from, z.to}) {
    if (errors_.has(k)) continue;
    errors_.add(k, P_.size() / 3);
    P_.append(Eigen::Matrix3d::Identity());
  }
}

Pose DelayedStateFilter::corrected_motion(const Innovation& z) const {
  if (!z.is_told) return z.motion;
  const Eigen::Vector3d motion =
      z.motion.vector() - z.G_from * errors_.estimate(z.from) - z.G_to * errors_.estimate(z.to);
  return {motion.x(), motion.y(), wrap_angle(motion.z())};
}

Eigen::Vector3d DelayedStateFilter::innovation_of(const Innovation& z) const {
  Eigen::Vector3d nu =
      corrected_motion(z).vector() - between(poses_[z.from], poses_[z.to]).vector();
  nu.z() = wrap_angle(nu.z());
  return z.rows.is_whole() ? nu : z.rows.C * nu;
}

DelayedStateFilter::Innovation DelayedStateFilter::innovate(const RelativePose& z) const {
  Innovation innovation;
  innovation.from = z.from;
  innovation.to = z.to;
  innovation.motion = z.motion;
  if (is_told(z)) {
    innovation.is_told = true;
    innovation.rows.R = z.shared->own;
    innovation.G_from = z.shared->from.scaled();
    innovation.G_to = z.shared->to.scaled();
  } else {
    innovation.rows = loop_rows(z);
  }
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

// By what R is in the update.
bool DelayedStateFilter::is_resolved_as_used(const RelativePose& z) const {
  if (!is_told(z)) return is_resolved(z, poses_[z.from], poses_[z.to]);
  return is_resolved(RelativePose::from_covariance(z.from, z.to, z.motion, z.shared->own),
                     poses_[z.from], poses_[z.to]);
}

UpdateReport DelayedStateFilter::close_loops(std::span<const RelativePose> registrations) {
  for (const RelativePose& z : registrations) {
    admit(z);
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
  const bool is_each_resolved =
      std::ranges::all_of(registrations, [&](const auto& z) { return is_resolved_as_used(z); });
  if (!has_finite_nis(report) || !is_each_resolved) {
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

}  // namespace fathom::filter
