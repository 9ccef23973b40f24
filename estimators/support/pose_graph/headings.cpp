#include "estimators/support/pose_graph/headings.hpp"

namespace fathom::pose_graph {
HeadingProblem::HeadingProblem(const sparse::Symbolic& symbolic, std::span<const Edge> edges)
    : edges_(edges), factor_(symbolic) {
  weights_.reserve(edges.size());
  factor_.clear();
  double* const data = factor_.data();
  for (const Edge& edge : edges) {
    const double w = heading_information(edge);
    weights_.push_back(w);
    for (const int keyframe : {edge.from, edge.to}) {
      if (keyframe > 0) data[factor_.place(keyframe - 1, keyframe - 1).offset] += w;
    }
    if (edge.from > 0 && edge.to > 0) {
      data[factor_.place(edge.from - 1, edge.to - 1).offset] -= w;
    }
  }
  factor_.factorise();
}

std::vector<double> HeadingProblem::solve(std::span<const double> theta) {
  const std::vector<int>& position = factor_.symbolic().position;
  std::vector<double> turn(theta.size() - 1, 0.0);
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    const Edge& edge = edges_[e];
    const double r =
        weights_[e] * wrap_angle(edge.theta - theta[at(edge.to)] + theta[at(edge.from)]);
    if (edge.to > 0) turn[at(position[at(edge.to - 1)])] += r;
    if (edge.from > 0) turn[at(position[at(edge.from - 1)])] -= r;
  }
  factor_.solve(turn.data());
  std::vector<double> result(theta.begin(), theta.end());
  for (std::size_t k = 1; k < result.size(); ++k) result[k] += turn[at(position[k - 1])];
  return result;
}

}  // namespace fathom::pose_graph
