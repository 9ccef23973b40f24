#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "estimators/trajectory_iekf/stacked_loops.hpp"
#include "fathom/estimation/precision.hpp"

namespace fathom {

void TrajectoryIekfOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "linearisations of one update at most; 1 is the trajectory EKF, 1000 with "
                "divergence_factor 1.0e12 the paper's, until "
                "it converges");
  table.real("tolerance", tolerance, Range::positive(), "m, rad",
             "an update has converged when no motion of the loop still moves by more");
  table.boolean("safeguard", safeguard,
                "shorten a step until the cost of the update does not rise");
  table.real("divergence_factor", divergence_factor, Range::at_least(1.0), "",
             "an update has diverged at so many times the cost of leaving the state alone");
  gate.describe(table);
  gate.describe_joint(table);
  shared_errors.describe_of_filter(table, ", as in the paper");
}

TrajectoryIekf::TrajectoryIekf(const EstimatorSetup& setup, const TrajectoryIekfOptions& options,
                               MotionCovariance::Form form)
    : options_(options), gate_(options.gate), poses_{setup.start.pose}, P_(form) {}

void TrajectoryIekf::add_keyframe(const RelativePose& step) {
  const RelativePose u = step.forward();
  motions_.push_back(u.motion);
  poses_.push_back(compose(poses_.back(), u.motion));
  P_.append(u.covariance());
  blocks_.add_motion();
  covariances_.clear();
}

void TrajectoryIekf::linearise(std::span<const StackedLoop> loops, const Eigen::VectorXd& delta,
                               int iteration) {
  const Stretch stretch = stretch_of(loops, delta);
  at_.nu = innovations_of(loops, stretch, delta);
  at_.H = jacobian_of(loops, stretch);
  auto PAt = at_.PAt.shaped(delta.size(), static_cast<Eigen::Index>(3 * at_.H.starts().size()));
  // A turn of a motion turns the newest keyframe as much, wherever H is taken: the third column of
  // Aᵀ is the same for all iterates.
  P_.suffix_products(at_.H.starts(), at_.H.A_transposed(), PAt, iteration);
  // So is all of G.
  if (iteration == 1) at_.PGt = picture_products();
  multiply(loops);
}

// S = H P Hᵀ + R.
void TrajectoryIekf::multiply(std::span<const StackedLoop> loops) {
  if (at_.PGt.size() == 0) {
    at_.S = at_.H.times(at_.PAt.matrix()) * at_.H.ends();
  } else {
    const Eigen::Index length = at_.PAt.matrix().rows();
    at_.S = at_.H.times(at_.PAt.matrix() * at_.H.ends() + at_.PGt.bottomRows(length));
  }
  for (Eigen::Index row = 0; row < at_.nu.size(); row += 3) {
    at_.S.block<3, 3>(row, row) += loops[static_cast<std::size_t>(row / 3)].rows.R;
  }
}

UpdateReport TrajectoryIekf::close_loops(std::span<const RelativePose> registrations) {
  UpdateReport report;
  if (registrations.empty()) return report;
  for (const RelativePose& z : registrations) admit(z);
  std::vector<StackedLoop> loops = stacked(registrations, model());
  linearise_prior(loops);
  for (const RelativePose& z : registrations) {
    report.loops.push_back({z.from, z.to, LoopFate::used, std::nullopt});
  }
  const std::vector<bool> passes = gate_loops(loops, report);
  if (!has_finite_nis(report) || !are_resolved_as_used(registrations)) {
    lose_all(report, Outcome::numerical_failure);
    return report;
  }
  if (std::find(passes.begin(), passes.end(), false) != passes.end()) {
    std::size_t j = 0;
    std::erase_if(loops, [&](const StackedLoop&) { return !passes[j++]; });
    if (loops.empty()) return report;
    narrow_to(loops);
  }
  report.outcome = iterate(loops, report);
  if (!is_done(report.outcome)) lose_all(report, report.outcome);
  return report;
}

void TrajectoryIekf::linearise_prior(std::span<const StackedLoop> loops) {
  const Eigen::Index length = 3 * (blocks_.size() - begin_of(loops));
  linearise(loops, Eigen::VectorXd::Zero(length), 1);
}

// The prior's linearisation for the registrations that are left of those it was made for. As long
// as they begin with the same motion, and none is told of n, the products with P are there already.
void TrajectoryIekf::narrow_to(std::span<const StackedLoop> loops) {
  const Eigen::Index begin = begin_of(loops);
  if (begin != at_.H.starts().front() || at_.PGt.size() > 0) return linearise_prior(loops);
  const Eigen::VectorXd none = Eigen::VectorXd::Zero(3 * (blocks_.size() - begin));
  const Stretch stretch = stretch_of(loops, none);
  const StackedJacobian was = std::exchange(at_.H, jacobian_of(loops, stretch));
  at_.nu = innovations_of(loops, stretch, none);
  auto PAt = at_.PAt.matrix();
  Eigen::Index column = 0;
  for (const Eigen::Index start : at_.H.starts()) {
    const auto found = std::ranges::find(was.starts(), start);
    const auto column_was = 3 * static_cast<Eigen::Index>(found - was.starts().begin());
    if (column_was != column) PAt.middleCols<3>(column) = PAt.middleCols<3>(column_was);
    column += 3;
  }
  at_.PAt.keep_columns(column);
  multiply(loops);
}

// Decides on every loop, in report.loops, at the prior.
std::vector<bool> TrajectoryIekf::gate_loops(std::span<const StackedLoop> loops,
                                             UpdateReport& report) const {
  std::vector<bool> passes;
  std::vector<int> ranks;
  for (std::size_t j = 0; j < loops.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(3 * j);
    const double nis =
        normalised_innovation_squared(at_.nu.segment<3>(row), at_.S.block<3, 3>(row, row));
    ranks.push_back(loops[j].rows.rank);
    passes.push_back(!gate_.is_on() || gate_.passes(nis, ranks.back()));
    report.loops[j].fate = fate_of(passes.back());
    report.loops[j].nis = nis;
  }
  if (gate_.is_joint_on() && has_finite_nis(report)) {
    passes = gate_.pass_together(at_.nu, at_.S, passes, ranks);
    for (std::size_t j = 0; j < passes.size(); ++j) report.loops[j].fate = fate_of(passes[j]);
  }
  return passes;
}

// The motion over a hole, which is correlated with no other, becomes that of the loop between its
// ends: what is known of it stays right however the motions between them are corrected.
std::optional<LoopDecision> TrajectoryIekf::bridge(const Bridge& bridge) {
  if (!bridge.loop) {
    const auto moved_pose = [&](std::size_t k) {
      return bridge.moves[k] ? compose(bridge.motion, poses_[k]) : poses_[k];
    };
    motions_[bridge.node - 1] = between(moved_pose(bridge.node - 1), moved_pose(bridge.node));
    recompose();
    return std::nullopt;
  }
  const RelativePose& loop = *bridge.loop;
  admit(loop);
  const std::vector<StackedLoop> loops = stacked(std::span(&loop, 1), model());
  UpdateReport report;
  report.loops.push_back({loop.from, loop.to, LoopFate::used, std::nullopt});
  linearise_prior(loops);
  gate_loops(loops, report);
  const LoopDecision decision = report.loops.front();
  if (!has_finite_nis(report)) return std::nullopt;
  if (decision.fate != LoopFate::used) return decision;
  tree_.set(bridge.node - 1, {loop.from, loop.to});
  take_place(bridge.node - 1, loops.front());
  recompose();
  return decision;
}

std::size_t TrajectoryIekf::first_of(std::span<const StackedLoop> loops) const {
  return first_motion(loops, tree_, motions_.size());
}

void TrajectoryIekf::recompose() {
  poses_ = tree_.poses(poses_.front(), motions_);
  covariances_.clear();
}

EstimatorEntry trajectory_iekf_entry() {
  return make_relative_entry<TrajectoryIekfOptions>(
      "trajectory_iekf",
      "trajectory-based iterated EKF of Burguera, Bonin-Font and Oliver (relative motions)", false,
      [](const EstimatorSetup& setup, const TrajectoryIekfOptions& options) {
        return std::make_unique<TrajectoryIekf>(setup, options);
      });
}

}  // namespace fathom
