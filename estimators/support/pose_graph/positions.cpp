#include "estimators/support/pose_graph/positions.hpp"

#include <algorithm>

namespace fathom::pose_graph {
PositionProblem::PositionProblem(sparse::BlockCholesky<3>& poses, std::span<const Edge> edges,
                                 const EdgeLoss& loss)
    : edges_(edges),
      loss_(loss),
      parts_(poses.symbolic(), edges),
      factor_(poses),
      step_(2 * at(poses.symbolic().size())) {}

void PositionProblem::add_up(std::span<const Node> nodes) {
  const sparse::Symbolic& symbolic = factor_.symbolic();
  const auto add = [&](int a, int b, const std::array<double, 6>& M, double sign) {
    const sparse::BlockPlace place = factor_.place(a - 1, b - 1);
    double* to = factor_.data() + place.offset;
    to[0] += sign * M[0];
    to[1] += sign * M[1];
    to[place.stride] += sign * M[1];
    to[place.stride + 1] += sign * M[3];
  };
  const auto add_at = [&](int keyframe, int position, const EdgeTerms& t, double sign) {
    add(keyframe, keyframe, t.M, 1.0);
    double* s = step_.data() + 2 * at(position);
    s[0] += sign * t.m[0];
    s[1] += sign * t.m[1];
  };
  parts_.for_each([&](std::size_t e, const auto& part) {
    if (loss_.leaves_out(e)) return;
    const Edge& edge = edges_[e];
    EdgeTerms t = linearise_edge(edge, nodes);
    loss_.apply(e, false, t);
    const int from = position_of(symbolic, edge.from);
    const int to = position_of(symbolic, edge.to);
    if (part.has(from)) add_at(edge.from, from, t, 1.0);
    if (part.has(to)) add_at(edge.to, to, t, -1.0);
    if (from < 0 || to < 0 || !part.has(std::min(from, to))) return;
    add(edge.from, edge.to, t.M, -1.0);
  });
  // The errors of pictures stay as they are.
  for (std::size_t k = keyframes_of(nodes); k < nodes.size(); ++k) {
    add(static_cast<int>(k), static_cast<int>(k), {1.0, 0.0, 0.0, 1.0, 0.0, 0.0}, 1.0);
  }
}

bool PositionProblem::solve(std::vector<Node>& nodes) {
  factor_.clear();
  std::fill(step_.begin(), step_.end(), 0.0);
  add_up(nodes);
  if (!factor_.factorise() || factor_.negative_pivots() > 0) return false;
  factor_.solve(step_.data());
  const std::vector<int>& position = factor_.symbolic().position;
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const double* s = step_.data() + 2 * at(position[k - 1]);
    nodes[k].x += s[0];
    nodes[k].y += s[1];
  }
  return true;
}

}  // namespace fathom::pose_graph
