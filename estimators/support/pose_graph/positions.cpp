#include "estimators/support/pose_graph/positions.hpp"

#include <array>

namespace fathom::pose_graph {
PositionProblem::PositionProblem(const sparse::Symbolic& symbolic, std::span<const Edge> edges,
                                 const EdgeLoss& loss)
    : edges_(edges), loss_(loss), factor_(symbolic) {}

bool PositionProblem::solve(std::vector<Node>& nodes) {
  const std::vector<int>& position = factor_.symbolic().position;
  std::vector<double> step(2 * position.size(), 0.0);
  factor_.clear();
  const auto add = [&](int a, int b, const std::array<double, 6>& M, double sign) {
    const sparse::BlockPlace place = factor_.place(a - 1, b - 1);
    double* to = factor_.data() + place.offset;
    to[0] += sign * M[0];
    to[1] += sign * M[1];
    to[place.stride] += sign * M[1];
    to[place.stride + 1] += sign * M[3];
  };
  for (std::size_t e = 0; e < edges_.size(); ++e) {
    if (loss_.leaves_out(e)) continue;
    const Edge& edge = edges_[e];
    EdgeTerms t = linearise_edge(edge, nodes[at(edge.from)], nodes[at(edge.to)]);
    loss_.apply(e, false, t);
    for (const int keyframe : {edge.from, edge.to}) {
      if (keyframe == 0) continue;
      add(keyframe, keyframe, t.M, 1.0);
      const double sign = keyframe == edge.from ? 1.0 : -1.0;
      double* s = step.data() + 2 * at(position[at(keyframe - 1)]);
      s[0] += sign * t.m[0];
      s[1] += sign * t.m[1];
    }
    if (edge.from > 0 && edge.to > 0) add(edge.from, edge.to, t.M, -1.0);
  }
  if (!factor_.factorise() || factor_.negative_pivots() > 0) return false;
  factor_.solve(step.data());
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const double* s = step.data() + 2 * at(position[k - 1]);
    nodes[k].x += s[0];
    nodes[k].y += s[1];
  }
  return true;
}

}  // namespace fathom::pose_graph
