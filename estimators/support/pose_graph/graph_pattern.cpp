// Which nodes of a graph are linked.

#include <array>

#include "estimators/support/pose_graph/normal_equations.hpp"

namespace fathom::pose_graph {
namespace {

void link_shared(const Edge& edge, std::vector<sparse::Link>& links) {
  const std::array ends{edge.from, edge.to, edge.shared->from.node, edge.shared->to.node};
  for (std::size_t a = 2; a < ends.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      if (ends[a] > 0 && ends[b] > 0) links.push_back({ends[a] - 1, ends[b] - 1});
    }
  }
}

}  // namespace

sparse::Symbolic analyse_graph(std::span<const Edge> edges, int nodes, Workers* workers,
                               sparse::ChainElimination chains) {
  std::vector<sparse::Link> links;
  links.reserve(edges.size());
  for (const Edge& edge : edges) {
    if (edge.from > 0 && edge.to > 0) links.push_back({edge.from - 1, edge.to - 1});
    if (edge.shared != nullptr) link_shared(edge, links);
  }
  return sparse::analyse(sparse::adjacency_of(nodes - 1, links), chains, workers);
}

}  // namespace fathom::pose_graph
