#include "estimators/support/pose_graph/turn_graph.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "fathom/core/disjoint_sets.hpp"

namespace fathom::pose_graph {
namespace {

// Whether steps that measure their turn lead from node 0 to all others: the usual case.
bool is_chain(std::span<const Edge> edges, std::size_t nodes) {
  std::vector<char> reached(nodes, 0);
  std::size_t left = nodes - 1;
  for (const Edge& edge : edges) {
    if (!measures_heading(edge)) return false;
    if (std::abs(edge.from - edge.to) != 1) continue;
    char& later = reached[at(std::max(edge.from, edge.to))];
    if (later == 0) --left;
    later = 1;
  }
  return left == 0;
}

}  // namespace

TurnGraph::TurnGraph(std::span<const Edge> edges, std::span<const Node> nodes) : all_(edges) {
  if (is_chain(edges, nodes.size())) return;
  DisjointSets parts(nodes.size());
  for (const Edge& edge : edges) {
    if (!measures_heading(edge)) continue;
    own_.push_back(edge);
    parts.join(at(edge.from), at(edge.to));
  }
  for (int k = 1; k < static_cast<int>(nodes.size()); ++k) {
    if (parts.root(at(k)) != at(k)) continue;
    Edge turn;
    turn.to = k;
    turn.theta = wrap_angle(nodes[at(k)].theta - nodes[0].theta);
    turn.W = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0};
    own_.push_back(turn);
  }
}

double TurnGraph::worst_turn(std::span<const double> theta) const {
  double worst = 0.0;
  for (const Edge& edge : edges()) {
    const double turn = theta[at(edge.to)] - theta[at(edge.from)];
    worst = std::max(worst, std::abs(wrap_angle(turn - edge.theta)));
  }
  return worst;
}

}  // namespace fathom::pose_graph
