#pragma once

#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge.hpp"

namespace fathom::pose_graph {

/// The edges from which headings alone can be computed: those that measure a turn, and where they
/// leave nodes without connection to node 0 (a hole in dead reckoning that position fixes bridge)
/// one more from node 0 for each such part of the graph, with the turn that `nodes` have. As it is
/// the only one, what it weighs changes nothing.
class TurnGraph {
 public:
  /// The edges must outlive it.
  TurnGraph(std::span<const Edge> edges, std::span<const Node> nodes);

  /// Whether they are the edges as they are.
  bool are_all() const { return own_.empty(); }
  std::span<const Edge> edges() const { return own_.empty() ? all_ : std::span<const Edge>(own_); }
  /// How far the turn of an edge is from what it measured at worst.
  double worst_turn(std::span<const double> theta) const;

 private:
  std::span<const Edge> all_;
  std::vector<Edge> own_;  ///< empty: all
};

}  // namespace fathom::pose_graph
