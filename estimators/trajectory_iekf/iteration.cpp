// The iterated update of TrajectoryIekf, from its first linearisation to the end of the iteration.

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimators/trajectory_iekf/stacked_loops.hpp"
#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

namespace fathom {

/// An iterate x = x⁽⁰⁾ + δ on the stretch. δ = P u with u = Hᵀ λ: the dual u gives δᵀ P⁻¹ δ = δᵀ u
/// without an inverse of P, and the motion of the state outside the stretch.
struct TrajectoryIekf::Iterate {
  Eigen::VectorXd delta;
  Eigen::VectorXd u;
  double cost = 0.0;
};

// From the prior, where the registrations are linearised already.
Outcome TrajectoryIekf::iterate(std::span<const StackedLoop> loops, UpdateReport& report) {
  const Eigen::Index length = at_.PAt.matrix().rows();
  Iterate x{Eigen::VectorXd::Zero(length), Eigen::VectorXd::Zero(length), misfit(loops, at_.nu)};
  const double prior_cost = x.cost;
  Outcome outcome = Outcome::iteration_limit;
  for (report.iterations = 1; true; ++report.iterations) {
    if (report.iterations > 1) linearise(loops, x.delta, report.iterations);
    const Eigen::LLT<Eigen::MatrixXd> S(at_.S);
    if (!at_.nu.allFinite() || S.info() != Eigen::Success) return Outcome::numerical_failure;
    // x⁽ⁱ⁺¹⁾ = x⁽⁰⁾ + P Hᵀ S⁻¹ (z − h(x⁽ⁱ⁾) − H (x⁽⁰⁾ − x⁽ⁱ⁾)): always from the prior, with h and H
    // of the present iterate.
    const Eigen::VectorXd lambda = S.solve(at_.nu + at_.H.times(x.delta));
    Iterate next{at_.PAt.matrix() * (at_.H.ends() * lambda), at_.H.transposed_times(lambda)};
    if (at_.PGt.size() > 0) next.delta += at_.PGt.bottomRows(length) * lambda;
    if (!next.delta.allFinite()) return Outcome::numerical_failure;
    const double step = largest_change(loops, next.delta - x.delta);
    const bool lowered = !options_.safeguard || step_back(loops, x, next);
    x = std::move(next);
    // A step that no halving makes lower is one of rounding: the gradient is zero as far as it
    // shows.
    if (step < options_.tolerance || !lowered) outcome = Outcome::converged;
    if (outcome == Outcome::converged || report.iterations >= options_.max_iterations) break;
  }
  const double end_cost = cost(loops, x);
  if (!std::isfinite(end_cost)) return Outcome::numerical_failure;
  if (end_cost > options_.divergence_factor * std::max(prior_cost, 1.0)) return Outcome::diverged;
  return apply(x, report.iterations) ? outcome : Outcome::numerical_failure;
}

double TrajectoryIekf::cost(std::span<const StackedLoop> loops, const Iterate& at) const {
  const Stretch stretch = stretch_of(loops, at.delta);
  return at.delta.dot(at.u) + misfit(loops, innovations_of(loops, stretch, at.delta));
}

// The full step minimises the linearised cost; the first of 1, ½, ¼ … of it that does not raise the
// true one is taken. False, and no step, if rounding leaves none.
bool TrajectoryIekf::step_back(std::span<const StackedLoop> loops, const Iterate& from,
                               Iterate& to) const {
  const Iterate full = to;
  constexpr int kHalvings = 40;  // 1e-12 of a step is rounding
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
bool TrajectoryIekf::apply(const Iterate& end, int iterations) {
  const Eigen::Index start = at_.H.starts().front();
  const Eigen::Index begin = P_.first_correlated(start);
  const Eigen::Index head = 3 * (start - begin);
  const Eigen::Index tail = end.delta.size();
  Eigen::VectorXd dx(head + tail);
  dx.tail(tail) = end.delta;
  auto V = V_.shaped(head + tail, at_.nu.size());
  V.bottomRows(tail).noalias() = at_.PAt.matrix() * at_.H.ends();
  if (head > 0) {
    V.topRows(head).noalias() =
        P_.head_products(at_.H.starts(), at_.H.A_transposed()) * at_.H.ends();
    Eigen::MatrixX3d u = Eigen::MatrixX3d::Zero(tail, 3);
    u.col(0) = end.u;
    dx.head(head) = P_.head_products(at_.H.starts().first(1), u).col(0);
  }
  if (at_.PGt.size() > 0) V += at_.PGt.bottomRows(head + tail);
  // V = P Hᵀ L⁻ᵀ.
  const Eigen::LLT<Eigen::MatrixXd> S(at_.S);
  S.matrixU().solveInPlace<Eigen::OnTheRight>(V);
  if (!dx.allFinite() || !V.allFinite()) return false;
  correct(dx);
  const std::span<const Eigen::Index> n = blocks_.pictures().blocks();
  if (model() == SharedErrorModel::consider && !n.empty()) {
    P_.downdate_but(n, V);
  } else {
    P_.downdate(V, iterations);
  }
  recompose();
  return true;
}

// By a correction of the last blocks of the state. n̂ that is only considered stays 0. The iterates
// of the motions are the same whether it does or not: in ν + H δ the n of an iterate cancels.
void TrajectoryIekf::correct(const Eigen::VectorXd& dx) {
  const Eigen::Index begin = blocks_.size() - dx.size() / 3;
  for (std::size_t i = motions_.size(); i-- > 0 && blocks_.of_motion(i) >= begin;) {
    motions_[i] = moved(motions_[i], dx.segment<3>(3 * (blocks_.of_motion(i) - begin)));
  }
  if (blocks_.are_motions_alone() || model() == SharedErrorModel::consider) return;
  Eigen::VectorXd whole = Eigen::VectorXd::Zero(P_.size());
  whole.tail(dx.size()) = dx;
  blocks_.pictures().correct(whole);
}

}  // namespace fathom
