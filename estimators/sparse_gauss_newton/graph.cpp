#include "estimators/sparse_gauss_newton/graph.hpp"

#include <algorithm>
#include <utility>

#include "estimators/support/pose_graph/bridge.hpp"
#include "estimators/support/pose_graph/information.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom::sparse_gauss_newton {

Graph::Graph(const EstimatorSetup& setup, const RobustOptions& robust, int threads)
    : robust_(robust),
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
  changed();
}

void Graph::add_keyframe(const RelativePose& step) {
  const Pose next = compose(pose(size() - 1), step.forward().motion);
  nodes_.push_back(make_node(next.x, next.y, next.theta));
  if (!is_batch_ || !step.is_hole) add_edge(step, 0, 3);
  changed();
}

void Graph::add_registration(const RelativePose& registration) {
  add_edge(registration, 1, rank_of(registration.information));
  changed();
}

void Graph::bridge(const Bridge& bridge) {
  pose_graph::bridge(bridge, edges_, nodes_);
  changed();
}

void Graph::add_edge(const RelativePose& measurement, char is_loop, int rank) {
  edges_.push_back(make_edge(measurement));
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
  edges_.resize(count);
  is_loop_.resize(count);
  ranks_.resize(count);
  weights_.resize(count);
  changed();
}

// Keeps the poses of a solve that is done.
SolveResult Graph::accept(SolveResult result, std::vector<Node> nodes,
                          const std::vector<double>& weights) {
  changed();
  if (is_done(result.outcome) && spread_.is_wide() &&
      !pose_graph::is_determined(weighted_edges(weights), nodes)) {
    result.outcome = Outcome::numerical_failure;
  }
  if (is_done(result.outcome)) nodes_ = std::move(nodes);
  return result;
}

SolveResult Graph::solve(Start start, const SolveLimits& limits) {
  std::vector<Node> nodes = nodes_;
  const SolveResult result = pose_graph::solve_batch(edges_, nodes, start, limits, workers());
  return accept(result, std::move(nodes), weights_);
}

SolveResult Graph::solve_robust(const SolveLimits& limits, bool from_scratch) {
  std::vector<double> known;
  if (!from_scratch) {
    known = weights_;
    for (std::size_t e = judged_; e < known.size(); ++e)
      known[e] = is_loop_[e] != 0 ? kNewLoop : 1.0;
  }
  std::vector<Node> nodes = nodes_;
  RobustResult robust = sparse_gauss_newton::solve_robust({edges_, is_loop_, ranks(), workers()},
                                                          nodes, robust_, limits, known);
  const SolveResult result = accept(robust.solved, std::move(nodes), robust.weights);
  if (is_done(result.outcome)) {
    weights_ = std::move(robust.weights);
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

std::vector<Edge> Graph::weighted_edges(const std::vector<double>& weights) const {
  std::vector<Edge> edges;
  edges.reserve(edges_.size());
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (weights[e] == 0.0) continue;
    edges.push_back(edges_[e]);
    for (double& element : edges.back().W) element *= weights[e];
  }
  return edges;
}

std::optional<Eigen::Matrix3d> Graph::marginal(std::size_t k) {
  if (!marginals_) {
    marginals_ = pose_graph::marginals(weighted_edges(weights_), nodes_)
                     .value_or(std::vector<Eigen::Matrix3d>{});
  }
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

std::optional<Eigen::MatrixXd> Graph::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  return pose_graph::joint_covariance(weighted_edges(weights_), nodes_, keyframes);
}

std::optional<std::vector<UncertainPose>> Graph::motions_to_newest() const {
  return pose_graph::motions_to_newest(weighted_edges(weights_), nodes_);
}

std::optional<std::vector<Eigen::Matrix3d>> Graph::predicted_covariances(
    std::span<const RelativePose> forward_loops) const {
  return pose_graph::predicted_covariances(weighted_edges(weights_), nodes_, forward_loops);
}

}  // namespace fathom::sparse_gauss_newton
