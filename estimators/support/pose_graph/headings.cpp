#include "estimators/support/pose_graph/headings.hpp"

#include <algorithm>
#include <cmath>

namespace fathom::pose_graph {
HeadingProblem::HeadingProblem(const sparse::Symbolic& symbolic, std::span<const Edge> edges)
    : edges_(edges), parts_(symbolic, edges), weights_(edges.size()), factor_(symbolic) {
  factor_.clear();
  for_ranges(symbolic.workers, edges.size(), kAtOnce, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) weights_[e] = heading_information(edges[e]);
  });
  double* const data = factor_.data();
  parts_.for_each([&](std::size_t e, const auto& part) {
    const Edge& edge = edges[e];
    const int from = position_of(symbolic, edge.from);
    const int to = position_of(symbolic, edge.to);
    if (part.has(from)) data[factor_.place(edge.from - 1, edge.from - 1).offset] += weights_[e];
    if (part.has(to)) data[factor_.place(edge.to - 1, edge.to - 1).offset] += weights_[e];
    if (from < 0 || to < 0 || !part.has(std::min(from, to))) return;
    data[factor_.place(edge.from - 1, edge.to - 1).offset] -= weights_[e];
  });
  is_solvable_ = factor_.factorise();
}

std::vector<double> HeadingProblem::solve(std::span<const double> theta,
                                          std::span<const double> given) {
  std::vector<double> result(theta.begin(), theta.end());
  if (!is_solvable_) return result;
  const sparse::Symbolic& symbolic = factor_.symbolic();
  std::vector<double> turn(theta.size() - 1, 0.0);
  parts_.for_each([&](std::size_t e, const auto& part) {
    const Edge& edge = edges_[e];
    const double residual =
        e < given.size() ? given[e]
                         : wrap_angle(edge.theta - theta[at(edge.to)] + theta[at(edge.from)]);
    const double r = weights_[e] * residual;
    const int to = position_of(symbolic, edge.to);
    const int from = position_of(symbolic, edge.from);
    if (part.has(to)) turn[at(to)] += r;
    if (part.has(from)) turn[at(from)] -= r;
  });
  factor_.solve(turn.data());
  for (std::size_t k = 1; k < result.size(); ++k) result[k] += turn[at(symbolic.position[k - 1])];
  return result;
}

double largest_turn(std::span<const double> from, std::span<const double> to) {
  double largest = 0.0;
  for (std::size_t k = 0; k < to.size(); ++k) {
    largest = std::max(largest, std::abs(to[k] - from[k]));
  }
  return largest;
}

}  // namespace fathom::pose_graph
