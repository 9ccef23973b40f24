// The errors that registrations of a picture share, as unknowns of a Smoother
// (docs/shared_errors.md).

#include <array>

#include "estimators/incremental_smoother/smoother.hpp"

namespace fathom::incremental_smoother {

void Smoother::grow_errors() {
  const std::size_t count = problem_.error_count();
  ignored_.errors.resize(count);
  marks_.changed_in.errors.resize(count, -1);
}

// A second registration of a picture: what its errors did to the first becomes a state. Of the
// poses F and its gradient are as they were, and the state is where F is least.
void Smoother::unfold(int keyframe) {
  const int e = problem_.pictures.folded_edge(keyframe);
  if (e < 0) return;
  const Edge& edge = problem_.edges[at(e)];
  for (const int end : {edge.from, edge.to}) tree_.settle(end);
  gradient_.take_out(e);
  problem_.unfold(keyframe);
  grow_errors();
  gradient_.evaluate(e);
  gradient_.evaluate_prior(keyframe);
  touch_ends(edge);
}

// Without states the graph itself.
pose_graph::ExtendedGraph Smoother::extended(const std::vector<Edge>& edges) const {
  if (!problem_.pictures.is_empty()) return problem_.pictures.extended(edges, problem_.nodes);
  pose_graph::ExtendedGraph graph;
  graph.edges = edges;
  graph.nodes = problem_.nodes;
  return graph;
}

std::vector<RelativePose> Smoother::without_errors(std::span<const RelativePose> registrations) {
  std::vector<RelativePose> apart;
  for (const RelativePose& z : registrations) {
    if (!has_states(z)) {
      apart.push_back(z);
      continue;
    }
    for (const auto& folded : problem_.pictures.folded_of(z, problem_.edges)) {
      const Edge& edge = problem_.edges[at(folded.edge)];
      for (const int end : {edge.from, edge.to}) tree_.settle(end);
    }
    apart.push_back(problem_.pictures.without_errors(z, problem_.edges, problem_.nodes));
  }
  return apart;
}

}  // namespace fathom::incremental_smoother
