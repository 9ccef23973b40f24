#include "estimators/sparse_gauss_newton/graph.hpp"

#include <algorithm>
#include <utility>

#include "estimators/support/pose_graph/bridge.hpp"
#include "estimators/support/pose_graph/information.hpp"
#include "estimators/support/pose_graph/wide.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::sparse_gauss_newton {

Graph::Graph(const EstimatorSetup& setup, const RobustOptions& robust,
             SharedErrorModel shared_errors, bool is_gated, int threads)
    : robust_(robust),
      shared_errors_(shared_errors),
      states_(!is_gated && !robust.loss.is_on()),
      is_batch_(setup.mode == SolveMode::batch),
      threads_(threads),
      nodes_{make_node(setup.start.pose.x, setup.start.pose.y, setup.start.pose.theta)} {}

Workers* Graph::workers() {
  if (threads_ > 1 && !workers_) workers_ = std::make_unique<Workers>(threads_);
  return workers_.get();
}

Pose Graph::pose(std::size_t k) const {
  return {nodes_[k].x, nodes_[k].y, wrap_angle(nodes_[k].theta)};
}

void Graph::set_poses(std::span<const Pose> poses) {
  for (std::size_t k = 1; k < nodes_.size(); ++k) {
    nodes_[k] = make_node(poses[k].x, poses[k].y, poses[k].theta);
  }
  states_.reset();
  changed();
}

void Graph::add_keyframe(const RelativePose& step) {
  const Node& last = nodes_.back();
  const Pose motion = step.from <= step.to ? step.motion : step.reversed().motion;
  nodes_.push_back(make_node(last.x + last.c * motion.x - last.s * motion.y,
                             last.y + last.s * motion.x + last.c * motion.y,
                             wrap_angle(wrap_angle(last.theta) + motion.theta)));
  if (!is_batch_ || !step.is_hole) add_edge(step, 0, 3);
  changed();
}

void Graph::add_registration(const RelativePose& registration) {
  if (registration.shared && shared_errors_ == SharedErrorModel::states) {
    states_.add(registration, edges_.size());
  }
  add_edge(registration, 1, rank_of(registration.information));
  changed();
}

void Graph::bridge(const Bridge& bridge) {
  pose_graph::bridge(bridge, edges_, nodes_);
  changed();
}

void Graph::add_edge(const RelativePose& measurement, char is_loop, int rank) {
  edges_.push_back(wide_rows_.make_edge(measurement));
  spread_.add(measurement);
  is_loop_.push_back(is_loop);
  ranks_.push_back(static_cast<char>(rank));
  weights_.push_back(1.0);
}

std::span<const char> Graph::ranks() const {
  const bool are_whole = std::ranges::all_of(ranks_, [](char rank) { return rank == 3; });
  return are_whole ? std::span<const char>() : ranks_;
}

void Graph::forget_edges(std::size_t count) {
  states_.forget_from(count);
  edges_.resize(count);
  is_loop_.resize(count);
  ranks_.resize(count);
  weights_.resize(count);
  changed();
}

// The graph with what each edge weighs, and without those that weigh nothing.
ExtendedGraph Graph::weighted(const std::vector<double>& weights) const {
  ExtendedGraph graph = states_.extended(edges_, nodes_);
  std::vector<Edge> kept;
  kept.reserve(graph.edges.size());
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (weights[e] == 0.0) continue;
    kept.push_back(graph.edges[e]);
    pose_graph::weigh(weights[e], kept.back());
  }
  graph.own_edges = std::move(kept);
  graph.edges = graph.own_edges;
  return graph;
}

// Keeps the estimate of a solve that is done.
SolveResult Graph::accept(const SolveResult& result, const ExtendedGraph& solved) {
  changed();
  if (is_done(result.outcome)) {
    states_.keep(solved);
    // Anew: over thousands of updates the rounding of moved() would add up.
    for (std::size_t k = 1; k < nodes_.size(); ++k) {
      const Node& node = solved.nodes[k];
      nodes_[k] = is_batch_ ? node : make_node(node.x, node.y, node.theta);
    }
  }
  return result;
}

SolveResult Graph::solve(Start start, const SolveLimits& limits) {
  ExtendedGraph graph = states_.extended(edges_, nodes_);
  const SolveResult result =
      pose_graph::solve_batch(graph.edges, graph.nodes, start, limits, workers());
  if (!spread_.is_wide()) return accept(searched(result, start, graph, limits), graph);
  const bool keeps_digits =
      is_done(result.outcome) && pose_graph::sums_keep_digits(graph.edges, graph.nodes);
  if (keeps_digits && result.outcome == Outcome::converged) return accept(result, graph);
  ExtendedGraph other = states_.extended(edges_, nodes_);
  const SolveResult wide =
      pose_graph::solve_wide(other.edges, other.nodes, start, limits, workers());
  return is_done(wide.outcome) || !keeps_digits ? accept(wide, other) : accept(result, graph);
}

// With states: of `truncated` the loops are judged as independent measurements, by their total
// covariances, and what is left is solved with states.
RobustResult Graph::robust_result(ExtendedGraph& graph, const SolveLimits& limits,
                                  std::span<const double> known) {
  const auto solve_it = [&](std::span<const Edge> edges, std::vector<Node>& nodes) {
    return sparse_gauss_newton::solve_robust({edges, is_loop_, ranks(), workers()}, nodes, robust_,
                                             limits, known);
  };
  if (!has_states() || robust_.loss.kind() != LossKind::truncated) {
    return solve_it(graph.edges, graph.nodes);
  }
  std::vector<Node> nodes = nodes_;
  RobustResult robust = solve_it(edges_, nodes);
  if (!is_done(robust.solved.outcome)) return robust;
  std::ranges::copy(nodes, graph.nodes.begin());
  const sparse::Symbolic symbolic =
      analyse_graph(graph.edges, static_cast<int>(graph.nodes.size()), workers());
  NormalEquations equations(symbolic, graph.edges);
  equations.set_loss({RobustLoss(), {}, robust.weights});
  const int judged = robust.solved.iterations;
  robust.solved = minimise(equations, graph.nodes, limits);
  robust.solved.iterations += judged;
  return robust;
}

SolveResult Graph::solve_robust(const SolveLimits& limits, bool from_scratch) {
  std::vector<double> known;
  if (!from_scratch) {
    known = weights_;
    for (std::size_t e = judged_; e < known.size(); ++e)
      known[e] = is_loop_[e] != 0 ? kNewLoop : 1.0;
  }
  ExtendedGraph graph = states_.extended(edges_, nodes_);
  RobustResult robust = robust_result(graph, limits, known);
  if (is_done(robust.solved.outcome) && spread_.is_wide() &&
      !pose_graph::sums_keep_digits(weighted(robust.weights).edges, graph.nodes)) {
    robust.solved.outcome = Outcome::numerical_failure;
  }
  const SolveResult result = accept(robust.solved, graph);
  if (is_done(result.outcome)) {
    weights_ = std::move(robust.weights);
    squared_scales_ = robust.squared_scales;
    judged_ = edges_.size();
  }
  return result;
}

std::vector<double> Graph::registration_weights() const {
  std::vector<double> weights;
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (is_loop_[e] != 0) weights.push_back(weights_[e]);
  }
  return weights;
}

std::optional<Eigen::Matrix3d> Graph::marginal(std::size_t k) {
  if (!marginals_) {
    const ExtendedGraph graph = weighted(weights_);
    marginals_ =
        pose_graph::marginals(graph.edges, graph.nodes).value_or(std::vector<Eigen::Matrix3d>{});
  }
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

std::optional<Eigen::MatrixXd> Graph::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  const ExtendedGraph graph = weighted(weights_);
  return pose_graph::joint_covariance(graph.edges, graph.nodes, keyframes);
}

std::optional<std::vector<UncertainPose>> Graph::motions_to_newest() const {
  const ExtendedGraph graph = weighted(weights_);
  return pose_graph::motions_to_newest(graph.edges, graph.nodes);
}

std::optional<std::vector<Eigen::Matrix3d>> Graph::predicted_covariances(
    std::span<const RelativePose> forward_loops) const {
  const ExtendedGraph graph = weighted(weights_);
  const bool is_shared =
      shared_errors_ == SharedErrorModel::states &&
      std::ranges::any_of(forward_loops, [](const RelativePose& z) { return z.shared != nullptr; });
  if (!is_shared) {
    return pose_graph::predicted_covariances(graph.edges, graph.nodes, forward_loops);
  }
  return pose_graph::predicted_shared_covariances(graph, forward_loops);
}

std::vector<RelativePose> Graph::without_errors(std::span<const RelativePose> registrations) const {
  std::vector<RelativePose> apart;
  for (const RelativePose& z : registrations) {
    apart.push_back(shared_errors_ == SharedErrorModel::states ? states_.without_errors(z) : z);
  }
  return apart;
}

}  // namespace fathom::sparse_gauss_newton
