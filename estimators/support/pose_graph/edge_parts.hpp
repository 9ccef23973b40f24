#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge.hpp"
#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::pose_graph {

/// Keyframes or edges that a thread takes at once where each costs the same.
inline constexpr std::size_t kAtOnce = 4096;

/// A range of positions in the order of elimination, and the edges with an end there.
struct EdgePart {
  int begin = 0;
  int end = 0;
  std::vector<int> edges;     ///< rising; none where `all_edges` is given
  std::size_t all_edges = 0;  ///< of the only part: all edges of the graph, so many

  /// False of the fixed keyframe, whose position is −1.
  bool has(int position) const { return position >= begin && position < end; }

  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t e = 0; e < all_edges; ++e) visit(e);
    for (const int e : edges) visit(static_cast<std::size_t>(e));
  }
};

/// What edges add to keyframes and pairs of them, added up part by part. Who has a keyframe adds up
/// all that is its own in the order of the edges, so the sums do not depend on the number of parts.
class EdgeParts {
 public:
  /// One part where the pattern has no workers.
  EdgeParts(const sparse::Symbolic& symbolic, std::span<const Edge> edges);

  /// add(part) for each part, by whoever is free.
  template <class Add>
  void for_each(const Add& add) const {
    for_ranges(workers_, parts_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) add(parts_[i]);
    });
  }

 private:
  Workers* workers_;
  std::vector<EdgePart> parts_;
};

/// The position of a keyframe, −1 of the fixed one.
inline int position_of(const sparse::Symbolic& symbolic, int keyframe) {
  return keyframe > 0 ? symbolic.position[at(keyframe - 1)] : -1;
}

}  // namespace fathom::pose_graph
