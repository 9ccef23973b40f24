#include "estimators/sparse_gauss_newton/graph.hpp"

#include "estimators/sparse_gauss_newton/information.hpp"

namespace fathom::sparse_gauss_newton {
Graph::Graph(const Pose& origin) : nodes_{make_node(origin.x, origin.y, origin.theta)} {}

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
  edges_.push_back(make_edge(step));
  changed();
}

void Graph::add_registration(const RelativePose& registration) {
  edges_.push_back(make_edge(registration));
  changed();
}

void Graph::forget_edges(std::size_t count) {
  edges_.resize(count);
  changed();
}

SolveResult Graph::solve(Start start, const SolveLimits& limits) {
  changed();
  return solve_batch(edges_, nodes_, start, limits);
}

std::optional<Eigen::Matrix3d> Graph::marginal(std::size_t k) {
  if (!marginals_) {
    marginals_ = marginals(edges_, nodes_).value_or(std::vector<Eigen::Matrix3d>{});
  }
  if (marginals_->empty()) return std::nullopt;
  return (*marginals_)[k];
}

std::optional<std::vector<UncertainPose>> Graph::motions_to_newest() const {
  return sparse_gauss_newton::motions_to_newest(edges_, nodes_);
}

std::optional<std::vector<Eigen::Matrix3d>> Graph::innovation_covariances(
    std::span<const RelativePose> forward_loops) const {
  return sparse_gauss_newton::innovation_covariances(edges_, nodes_, forward_loops);
}

}  // namespace fathom::sparse_gauss_newton
