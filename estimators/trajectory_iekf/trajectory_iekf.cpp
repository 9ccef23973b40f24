#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include <Eigen/Cholesky>

#include "estimators/trajectory_iekf/stretch.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

/// z − h and H of the stacked registrations at one iterate, and S = H P Hᵀ + R factored.
struct TrajectoryIekf::Linearisation {
  std::size_t first = 0;  ///< the stretch starts after this keyframe
  Eigen::VectorXd nu;     ///< z − h(x), headings wrapped
  Eigen::MatrixXd H;      ///< over the stretch only; zero elsewhere
  Eigen::MatrixXd PHt;    ///< rows of the stretch only
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

TrajectoryIekf::TrajectoryIekf(const EstimatorSetup& setup, const TrajectoryIekfOptions& options)
    : options_(options), gate_(options.gate), poses_{setup.origin} {}

void TrajectoryIekf::add_keyframe(const RelativePose& step) {
  const RelativePose u = step.forward();
  motions_.push_back(u.motion);
  poses_.push_back(compose(poses_.back(), u.motion));
  P_.append(u.covariance());
  covariances_.clear();
}

TrajectoryIekf::Linearisation TrajectoryIekf::linearise(std::span<const RelativePose> loops,
                                                        std::size_t first,
                                                        const Eigen::VectorXd& delta) const {
  const auto rows = static_cast<Eigen::Index>(3 * loops.size());
  const Stretch stretch = stretch_at(motions_, first, delta);
  Linearisation at;
  at.first = first;
  at.nu.resize(rows);
  at.H.resize(rows, delta.size());
  for (Eigen::Index j = 0; j < rows; j += 3) {
    const RelativePose& loop = loops[static_cast<std::size_t>(j / 3)];
    at.nu.segment<3>(j) = innovation(loop, stretch);
    at.H.middleRows<3>(j) = stretch.H(loop.from);
  }
  at.PHt = P_.tail_times(static_cast<Eigen::Index>(first), at.H.transpose());
  at.S = at.H * at.PHt;
  for (Eigen::Index j = 0; j < rows; j += 3) {
    at.S.block<3, 3>(j, j) += loops[static_cast<std::size_t>(j / 3)].covariance();
  }
  return at;
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
    prior = linearise_prior(loops);
  }
  report.outcome = iterate(loops, std::move(prior), report);
  if (!is_done(report.outcome)) lose_all(report, report.outcome);
  return report;
}

TrajectoryIekf::Linearisation TrajectoryIekf::linearise_prior(
    std::span<const RelativePose> loops) const {
  const std::size_t first = earliest_from(loops);
  const auto length = static_cast<Eigen::Index>(3 * (motions_.size() - first));
  return linearise(loops, first, Eigen::VectorXd::Zero(length));
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

Outcome TrajectoryIekf::iterate(std::span<const RelativePose> loops, Linearisation at,
                                UpdateReport& report) {
  const std::size_t first = at.first;
  const Eigen::Index length = at.H.cols();
  Iterate x{Eigen::VectorXd::Zero(length), Eigen::VectorXd::Zero(length)};
  x.cost = cost(loops, first, x);
  const double prior_cost = x.cost;
  Outcome outcome = Outcome::iteration_limit;
  for (report.iterations = 1; true; ++report.iterations) {
    if (report.iterations > 1) at = linearise(loops, first, x.delta);
    const Eigen::LLT<Eigen::MatrixXd> S(at.S);
    if (!at.nu.allFinite() || S.info() != Eigen::Success) return Outcome::numerical_failure;
    // x⁽ⁱ⁺¹⁾ = x⁽⁰⁾ + P Hᵀ S⁻¹ (z − h(x⁽ⁱ⁾) − H (x⁽⁰⁾ − x⁽ⁱ⁾)): always from the prior, with h and H
    // of the present iterate.
    const Eigen::VectorXd lambda = S.solve(at.nu + at.H * x.delta);
    Iterate next{at.PHt * lambda, at.H.transpose() * lambda};
    if (!next.delta.allFinite()) return Outcome::numerical_failure;
    const double step = (next.delta - x.delta).cwiseAbs().maxCoeff();
    const bool lowered = !options_.safeguard || step_back(loops, first, x, next);
    x = std::move(next);
    // A step that no halving makes lower is one of rounding: the gradient is zero as far as it
    // shows.
    if (step < options_.tolerance || !lowered) outcome = Outcome::converged;
    if (outcome == Outcome::converged || report.iterations >= options_.max_iterations) break;
  }
  const double end_cost = cost(loops, first, x);
  if (!std::isfinite(end_cost)) return Outcome::numerical_failure;
  if (end_cost > kDivergence * std::max(prior_cost, 1.0)) return Outcome::diverged;
  return apply(at, x) ? outcome : Outcome::numerical_failure;
}

double TrajectoryIekf::cost(std::span<const RelativePose> loops, std::size_t first,
                            const Iterate& at) const {
  const Stretch stretch = stretch_at(motions_, first, at.delta);
  double sum = at.delta.dot(at.u);
  for (const RelativePose& loop : loops) {
    sum += normalised_innovation_squared(innovation(loop, stretch), loop.covariance());
  }
  return sum;
}

// The full step minimises the linearised cost; the first of 1, ½, ¼ … of it that does not raise the
// true one is taken. False, and no step, if rounding leaves none.
bool TrajectoryIekf::step_back(std::span<const RelativePose> loops, std::size_t first,
                               const Iterate& from, Iterate& to) const {
  const Iterate full = to;
  constexpr int kHalvings = 40;
  double share = 1.0;
  for (int i = 0; i < kHalvings; ++i, share *= 0.5) {
    to.delta = from.delta + share * (full.delta - from.delta);
    to.u = from.u + share * (full.u - from.u);
    to.cost = cost(loops, first, to);
    if (to.cost <= from.cost) return true;
  }
  to = from;
  return false;
}

// The covariance is updated once, with the H of the last linearisation.
bool TrajectoryIekf::apply(const Linearisation& last, const Iterate& end) {
  const auto first = static_cast<Eigen::Index>(last.first);
  Eigen::MatrixXd Ht_u(last.H.cols(), last.H.rows() + 1);
  Ht_u << last.H.transpose(), end.u;
  const Eigen::MatrixXd product = P_.times(first, Ht_u);
  const auto PHt = product.leftCols(last.H.rows());
  const Eigen::VectorXd dx = product.rightCols<1>();
  const Eigen::LLT<Eigen::MatrixXd> S(last.S);
  const Eigen::MatrixXd W = S.matrixL().solve(PHt.transpose());
  if (!dx.allFinite() || !W.allFinite()) return false;
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    motions_[i] = moved(motions_[i], dx.segment<3>(static_cast<Eigen::Index>(3 * i)));
  }
  P_.downdate(W);
  recompose();
  return true;
}

void TrajectoryIekf::recompose() {
  poses_ = compose_trajectory(poses_.front(), motions_);
  covariances_.clear();
}

// X_k = X_{k−1} ⊕ x_k. Beside the covariance Σ of X_k its cross covariance M with all later motions
// is carried along: n² steps for all poses, where mapping each by its own Jacobian takes n³.
void TrajectoryIekf::compute_covariances() {
  const Eigen::Index n = P_.size();
  Eigen::Matrix3d Sigma = Eigen::Matrix3d::Zero();
  Eigen::Matrix3Xd M = Eigen::Matrix3Xd::Zero(3, n);
  covariances_.assign(1, Sigma);
  for (Eigen::Index k = 0; 3 * k < n; ++k) {
    Eigen::Matrix3d J_pose;
    Eigen::Matrix3d J_motion;
    const auto index = static_cast<std::size_t>(k);
    compose(poses_[index], motions_[index], &J_pose, &J_motion);
    const Eigen::Matrix3d cross = J_pose * M.middleCols<3>(3 * k) * J_motion.transpose();
    Sigma =
        transport(J_pose, Sigma) + cross + cross.transpose() + transport(J_motion, P_.block(k, k));
    const Eigen::Index later = n - 3 * (k + 1);
    M.rightCols(later) =
        (J_pose * M.rightCols(later) + J_motion * P_.column(k).bottomRows(later).transpose())
            .eval();
    covariances_.push_back(Sigma);
  }
}

std::optional<Eigen::Matrix3d> TrajectoryIekf::covariance(std::size_t k) {
  if (covariances_.empty()) compute_covariances();
  return covariances_[k];
}

// r_k = x_{k+1} ⊕ r_{k+1}, from the newest keyframe backwards. Beside the covariance Σ of r its
// cross covariance M with all earlier motions is carried along: n² steps for all, where J P Jᵀ of
// each stretch by itself takes n³.
std::optional<std::vector<UncertainPose>> TrajectoryIekf::motions_to_newest() const {
  std::vector<UncertainPose> motions(motions_.size());
  UncertainPose rest;
  Eigen::Matrix3Xd M = Eigen::Matrix3Xd::Zero(3, P_.size());
  for (std::size_t k = motions_.size(); k-- > 0;) {
    Eigen::Matrix3d J_motion;
    Eigen::Matrix3d J_rest;
    const Pose motion = compose(motions_[k], rest.mean, &J_motion, &J_rest);
    const auto block = static_cast<Eigen::Index>(k);
    const Eigen::Matrix3d cross =
        J_motion * M.middleCols<3>(3 * block).transpose() * J_rest.transpose();
    const Eigen::Matrix3d covariance = transport(J_motion, P_.block(block, block)) + cross +
                                       cross.transpose() + transport(J_rest, rest.covariance);
    rest = motions[k] = {motion, covariance};
    const Eigen::Index earlier = 3 * block;
    M.leftCols(earlier) =
        (J_rest * M.leftCols(earlier) + J_motion * P_.column(block).topRows(earlier).transpose())
            .eval();
  }
  return motions;
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
