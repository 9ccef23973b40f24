#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Cholesky>

namespace fathom {

/// z − h and H of the stacked registrations at one iterate, and S = H P Hᵀ + R.
struct TrajectoryIekf::Linearisation {
  Eigen::VectorXd nu;  ///< z − h(x), headings wrapped
  StackedJacobian H;   ///< over the stretch only; zero elsewhere
  Eigen::MatrixXd S;
};

/// An iterate x = x⁽⁰⁾ + δ on the stretch. δ = P u with u = Hᵀ λ: the dual u gives δᵀ P⁻¹ δ = δᵀ u
/// without an inverse of P, and the motion of the state outside the stretch.
struct TrajectoryIekf::Iterate {
  Eigen::VectorXd delta;
  Eigen::VectorXd u;
  double cost = 0.0;
};

namespace {

// An update that ends at so many times the cost of leaving the state alone (or 1, of a χ²: below it
// a cost is good whatever it was) has diverged. Plain iterations that have not settled end a little
// above it at times (on ring, twice up to 1.5 times), which is for `iteration_limit` to say.
constexpr double kDivergence = 10.0;

std::vector<std::size_t> froms_of(std::span<const RelativePose> loops) {
  std::vector<std::size_t> froms;
  for (const RelativePose& loop : loops) froms.push_back(loop.from);
  return froms;
}

std::size_t earliest_from(std::span<const RelativePose> loops) {
  std::size_t first = loops.front().from;
  for (const RelativePose& loop : loops) first = std::min(first, loop.from);
  return first;
}

Pose moved(const Pose& motion, const Eigen::Vector3d& delta) {
  return {motion.x + delta.x(), motion.y + delta.y(), wrap_angle(motion.theta + delta.z())};
}

Eigen::Vector3d innovation(const RelativePose& loop, const Stretch& stretch) {
  Eigen::Vector3d nu = loop.motion.vector() - stretch.h(loop.from).vector();
  nu.z() = wrap_angle(nu.z());
  return nu;
}

Eigen::VectorXd innovations(std::span<const RelativePose> loops, const Stretch& stretch) {
  Eigen::VectorXd nu(static_cast<Eigen::Index>(3 * loops.size()));
  for (std::size_t j = 0; j < loops.size(); ++j) {
    nu.segment<3>(static_cast<Eigen::Index>(3 * j)) = innovation(loops[j], stretch);
  }
  return nu;
}

// ν(x)ᵀ R⁻¹ ν(x).
double misfit(std::span<const RelativePose> loops, const Eigen::VectorXd& nu) {
  double sum = 0.0;
  for (std::size_t j = 0; j < loops.size(); ++j) {
    sum += normalised_innovation_squared(nu.segment<3>(static_cast<Eigen::Index>(3 * j)),
                                         loops[j].covariance());
  }
  return sum;
}

Stretch stretch_at(const std::vector<Pose>& motions, std::size_t first,
                   const Eigen::VectorXd& delta) {
  std::vector<Pose> at(motions.begin() + static_cast<std::ptrdiff_t>(first), motions.end());
  for (std::size_t i = 0; i < at.size(); ++i) {
    at[i] = moved(at[i], delta.segment<3>(static_cast<Eigen::Index>(3 * i)));
  }
  return {first, at};
}

}  // namespace

void TrajectoryIekfOptions::describe(OptionTable& table) {
  table.integer("max_iterations", max_iterations, Range::at_least(1), "",
                "linearisations of one update at most; 1 is the trajectory EKF");
  table.real("tolerance", tolerance, Range::positive(), "m, rad",
             "an update has converged when no motion of the loop still moves by more");
  table.boolean("safeguard", safeguard,
                "shorten a step until the cost of the update does not rise");
  gate.describe(table);
  gate.describe_joint(table);
}

TrajectoryIekf::TrajectoryIekf(const EstimatorSetup& setup, const TrajectoryIekfOptions& options,
                               MotionCovariance::Form form)
    : options_(options), gate_(options.gate), poses_{setup.origin}, P_(form) {}

void TrajectoryIekf::add_keyframe(const RelativePose& step) {
  const RelativePose u = step.forward();
  motions_.push_back(u.motion);
  poses_.push_back(compose(poses_.back(), u.motion));
  P_.append(u.covariance());
  covariances_.clear();
}

TrajectoryIekf::Linearisation TrajectoryIekf::linearise(std::span<const RelativePose> loops,
                                                        const Eigen::VectorXd& delta,
                                                        int iteration) {
  const Stretch stretch = stretch_at(motions_, earliest_from(loops), delta);
  StackedJacobian H(stretch, froms_of(loops));
  auto sums = sums_.shaped(delta.size(), static_cast<Eigen::Index>(3 * H.starts().size()));
  // A turn of a motion turns the newest keyframe as much, wherever H is taken: the third column of
  // Aᵀ is the same for all iterates.
  P_.suffix_products(H.starts(), H.A_transposed(), sums, iteration);
  return multiplied(loops, innovations(loops, stretch), std::move(H));
}

// S = H P Hᵀ + R, with P Hᵀ = (P Aᵀ from each start on) E.
TrajectoryIekf::Linearisation TrajectoryIekf::multiplied(std::span<const RelativePose> loops,
                                                         Eigen::VectorXd nu, StackedJacobian H) {
  Eigen::MatrixXd S = H.times(sums_.matrix()) * H.ends();
  for (Eigen::Index row = 0; row < nu.size(); row += 3) {
    S.block<3, 3>(row, row) += loops[static_cast<std::size_t>(row / 3)].covariance();
  }
  return {std::move(nu), std::move(H), std::move(S)};
}

UpdateReport TrajectoryIekf::close_loops(std::span<const RelativePose> registrations) {
  UpdateReport report;
  if (registrations.empty()) return report;
  std::vector<RelativePose> loops;
  for (const RelativePose& z : registrations) loops.push_back(z.forward());
  Linearisation prior = linearise_prior(loops);
  const std::vector<bool> passes = gate_loops(prior, registrations, report);
  if (!has_finite_nis(report)) {
    lose_all(report, Outcome::numerical_failure);
    return report;
  }
  if (std::find(passes.begin(), passes.end(), false) != passes.end()) {
    std::size_t j = 0;
    std::erase_if(loops, [&](const RelativePose&) { return !passes[j++]; });
    if (loops.empty()) return report;
    prior = narrowed(prior, loops);
  }
  report.outcome = iterate(loops, std::move(prior), report);
  if (!is_done(report.outcome)) lose_all(report, report.outcome);
  return report;
}

TrajectoryIekf::Linearisation TrajectoryIekf::linearise_prior(std::span<const RelativePose> loops) {
  const auto length = static_cast<Eigen::Index>(3 * (motions_.size() - earliest_from(loops)));
  return linearise(loops, Eigen::VectorXd::Zero(length), 1);
}

// The prior's linearisation for the registrations that are left of those it was made for. As long
// as they begin with the same motion the products with P are there already.
TrajectoryIekf::Linearisation TrajectoryIekf::narrowed(const Linearisation& prior,
                                                       std::span<const RelativePose> loops) {
  const std::size_t first = earliest_from(loops);
  if (static_cast<Eigen::Index>(first) != prior.H.starts().front()) return linearise_prior(loops);
  const Stretch stretch(first, std::span(motions_).subspan(first));
  StackedJacobian H(stretch, froms_of(loops));
  auto sums = sums_.matrix();
  Eigen::Index column = 0;
  for (const Eigen::Index start : H.starts()) {
    const auto was = std::find(prior.H.starts().begin(), prior.H.starts().end(), start);
    const auto column_was = 3 * static_cast<Eigen::Index>(was - prior.H.starts().begin());
    if (column_was != column) sums.middleCols<3>(column) = sums.middleCols<3>(column_was);
    column += 3;
  }
  sums_.keep_columns(column);
  return multiplied(loops, innovations(loops, stretch), std::move(H));
}

std::vector<bool> TrajectoryIekf::gate_loops(const Linearisation& prior,
                                             std::span<const RelativePose> registrations,
                                             UpdateReport& report) const {
  std::vector<bool> passes;
  for (std::size_t j = 0; j < registrations.size(); ++j) {
    const auto row = static_cast<Eigen::Index>(3 * j);
    const double nis =
        normalised_innovation_squared(prior.nu.segment<3>(row), prior.S.block<3, 3>(row, row));
    passes.push_back(!gate_.is_on() || gate_.passes(nis));
    report.loops.push_back(
        {registrations[j].from, registrations[j].to, fate_of(passes.back()), nis});
  }
  if (gate_.is_joint_on() && has_finite_nis(report)) {
    passes = gate_.pass_together(prior.nu, prior.S, passes);
    for (std::size_t j = 0; j < passes.size(); ++j) report.loops[j].fate = fate_of(passes[j]);
  }
  return passes;
}

// The products of P with the present linearisation are in sums_.
Outcome TrajectoryIekf::iterate(std::span<const RelativePose> loops, Linearisation at,
                                UpdateReport& report) {
  const Eigen::Index length = sums_.matrix().rows();
  Iterate x{Eigen::VectorXd::Zero(length), Eigen::VectorXd::Zero(length), misfit(loops, at.nu)};
  const double prior_cost = x.cost;
  Outcome outcome = Outcome::iteration_limit;
  for (report.iterations = 1; true; ++report.iterations) {
    if (report.iterations > 1) at = linearise(loops, x.delta, report.iterations);
    const Eigen::LLT<Eigen::MatrixXd> S(at.S);
    if (!at.nu.allFinite() || S.info() != Eigen::Success) return Outcome::numerical_failure;
    // x⁽ⁱ⁺¹⁾ = x⁽⁰⁾ + P Hᵀ S⁻¹ (z − h(x⁽ⁱ⁾) − H (x⁽⁰⁾ − x⁽ⁱ⁾)): always from the prior, with h and H
    // of the present iterate.
    const Eigen::VectorXd lambda = S.solve(at.nu + at.H.times(x.delta));
    Iterate next{sums_.matrix() * (at.H.ends() * lambda), at.H.transposed_times(lambda)};
    if (!next.delta.allFinite()) return Outcome::numerical_failure;
    const double step = (next.delta - x.delta).cwiseAbs().maxCoeff();
    const bool lowered = !options_.safeguard || step_back(loops, x, next);
    x = std::move(next);
    // A step that no halving makes lower is one of rounding: the gradient is zero as far as it
    // shows.
    if (step < options_.tolerance || !lowered) outcome = Outcome::converged;
    if (outcome == Outcome::converged || report.iterations >= options_.max_iterations) break;
  }
  const double end_cost = cost(loops, x);
  if (!std::isfinite(end_cost)) return Outcome::numerical_failure;
  if (end_cost > kDivergence * std::max(prior_cost, 1.0)) return Outcome::diverged;
  return apply(at, x, report.iterations) ? outcome : Outcome::numerical_failure;
}

double TrajectoryIekf::cost(std::span<const RelativePose> loops, const Iterate& at) const {
  const Stretch stretch = stretch_at(motions_, earliest_from(loops), at.delta);
  return at.delta.dot(at.u) + misfit(loops, innovations(loops, stretch));
}

// The full step minimises the linearised cost; the first of 1, ½, ¼ … of it that does not raise the
// true one is taken. False, and no step, if rounding leaves none.
bool TrajectoryIekf::step_back(std::span<const RelativePose> loops, const Iterate& from,
                               Iterate& to) const {
  const Iterate full = to;
  constexpr int kHalvings = 40;
  double share = 1.0;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    to.delta = from.delta + share * (full.delta - from.delta);
    to.u = from.u + share * (full.u - from.u);
    to.cost = cost(loops, to);
    if (to.cost <= from.cost) return true;
  }
  to = from;
  return false;
}

// The covariance is updated once, with the H of the last linearisation. On the stretch δ and P Hᵀ
// are known; the motions before it move as far as they are correlated with it.
bool TrajectoryIekf::apply(const Linearisation& last, const Iterate& end, int iterations) {
  const Eigen::Index start = last.H.starts().front();
  const Eigen::Index begin = P_.first_correlated(start);
  const Eigen::Index head = 3 * (start - begin);
  const Eigen::Index tail = end.delta.size();
  Eigen::VectorXd dx(head + tail);
  dx.tail(tail) = end.delta;
  auto V = V_.shaped(head + tail, last.nu.size());
  V.bottomRows(tail).noalias() = sums_.matrix() * last.H.ends();
  if (head > 0) {
    V.topRows(head).noalias() =
        P_.head_products(last.H.starts(), last.H.A_transposed()) * last.H.ends();
    Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(tail, 3);
    u.col(0) = end.u;
    dx.head(head) = P_.head_products(last.H.starts().first(1), u).col(0);
  }
  // V = P Hᵀ L⁻ᵀ.
  const Eigen::LLT<Eigen::MatrixXd> S(last.S);
  S.matrixU().solveInPlace<Eigen::OnTheRight>(V);
  if (!dx.allFinite() || !V.allFinite()) return false;
  for (std::size_t i = static_cast<std::size_t>(begin); i < motions_.size(); ++i) {
    const Eigen::Index row = 3 * (static_cast<Eigen::Index>(i) - begin);
    motions_[i] = moved(motions_[i], dx.segment<3>(row));
  }
  P_.downdate(V, iterations);
  recompose();
  return true;
}

void TrajectoryIekf::recompose() {
  poses_ = compose_trajectory(poses_.front(), motions_);
  covariances_.clear();
}

EstimatorEntry trajectory_iekf_entry() {
  return make_entry<TrajectoryIekfOptions>(
      "trajectory_iekf",
      "trajectory-based iterated EKF of Burguera, Bonin-Font and Oliver (relative motions)", false,
      [](const EstimatorSetup& setup, const TrajectoryIekfOptions& options) {
        return std::make_unique<TrajectoryIekf>(setup, options);
      });
}

}  // namespace fathom
