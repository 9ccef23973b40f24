// What a loss on the loops changes in a Smoother (docs/estimators/incremental_smoother.md#loss).

#include <algorithm>
#include <cmath>

#include "estimators/incremental_smoother/smoother.hpp"
#include "estimators/support/pose_graph/solver.hpp"

namespace fathom::incremental_smoother {

// By how much F may still exceed what the step aimed at. Without a loss, promise and result differ
// by terms of third order, and what is left is of fourth. The matrix of a loss leaves out what ρ''
// takes from it. Along a motion of which that is a share λ a step brings 1 + λ of its promise, and
// leaves λ² / (1 − λ).
double Smoother::left_by_step(Progress& progress, double promised, double brought) const {
  const double off = std::abs(promised - brought);
  if (!problem_.loops.is_on()) return off;
  const double share = promised > 0.0 ? brought / promised - 1.0 : 0.0;
  progress.lost_curvature = std::clamp(share, 0.0, limits_.most_lost_curvature);
  return off * std::max(1.0, progress.lost_curvature / (1.0 - progress.lost_curvature));
}

// A loss is far from quadratic where new loops change what they weigh: so a step leaves much, and
// all of it where the update has changed the gradient.
bool Smoother::goes_on_locally(Progress& progress, double left, double most_slack) const {
  if (!problem_.loops.is_on() || progress.is_whole) return false;
  return left > most_slack && ++progress.local_steps < limits_.steps_of_a_kind;
}

// Newton's steps know ρ''.
bool Smoother::wants_newton(Progress& progress) const {
  if (!problem_.loops.is_on() || !progress.is_whole) return false;
  return ++progress.whole_steps >= limits_.steps_of_a_kind;
}

// From its nodes on, with Newton steps near the end, and with the loss.
SmootherResult Smoother::minimise_whole(pose_graph::ExtendedGraph& graph) const {
  const sparse::Symbolic symbolic =
      pose_graph::analyse_graph(graph.edges, static_cast<int>(graph.nodes.size()));
  pose_graph::NormalEquations equations(symbolic, graph.edges);
  equations.set_loss({problem_.loops.loss(), problem_.loops.is_loop(), {}, problem_.loops.ranks()});
  const auto solved =
      pose_graph::minimise(equations, graph.nodes, {limits_.max_iterations, limits_.tolerance});
  return {solved.outcome, solved.iterations};
}

std::vector<double> Smoother::loop_weights() const {
  std::vector<double> weights;
  for (int e = 0; e < problem_.edge_count(); ++e) {
    if (problem_.loops.has(e)) weights.push_back(problem_.loops.present(e));
  }
  return weights;
}

pose_graph::ExtendedGraph Smoother::weighted_graph() {
  tree_.settle();
  if (!problem_.loops.is_on()) return extended(problem_.edges);
  std::vector<Edge> weighted = problem_.edges;
  for (int e = 0; e < problem_.edge_count(); ++e) {
    pose_graph::weigh(problem_.loops.present(e), weighted[at(e)]);
  }
  return problem_.pictures.extended(std::move(weighted), problem_.nodes);
}

}  // namespace fathom::incremental_smoother
