#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge.hpp"
#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::pose_graph {

/// Keyframes or edges that a thread takes at once where each costs the same.
inline constexpr std::size_t kAtOnce = 4096;

/// The position of a keyframe in the order of elimination, −1 of the fixed one.
inline int position_of(const sparse::Symbolic& symbolic, int keyframe) {
  return keyframe > 0 ? symbolic.position[at(keyframe - 1)] : -1;
}

/// All keyframes but the fixed one.
struct AllPositions {
  bool has(int position) const { return position >= 0; }
};

/// A range of positions, and the edges with an end there.
struct EdgePart {
  struct Member {
    int edge = 0;
    bool is_counted = false;  ///< of its parts, this one counts its term of a sum
  };
  int begin = 0;
  int end = 0;
  std::vector<Member> edges;  ///< rising

  bool has(int position) const { return position >= begin && position < end; }
};

/// What edges add to keyframes and pairs of them, added up part by part, each by whoever is free.
/// Who has a keyframe adds up all that is its own in the order of the edges, and who has the first
/// of a pair what is the pair's, so the sums do not depend on the number of parts.
class EdgeParts {
 public:
  /// One part where the pattern has no workers.
  EdgeParts(const sparse::Symbolic& symbolic, std::span<const Edge> edges);

  /// visit(edge, part): once where there is one part, AllPositions; else for each part that has an
  /// end of the edge.
  template <class Visit>
  void for_each(const Visit& visit) const {
    if (workers_ == nullptr) {
      for (std::size_t e = 0; e < edges_; ++e) visit(e, AllPositions{});
      return;
    }
    share([&](const EdgePart& part) {
      for (const EdgePart::Member& member : part.edges) visit(at(member.edge), part);
    });
  }

  /// The same; and the sum of what it returns for the edges, in their order.
  template <class Visit>
  double sum(const Visit& visit) {
    double result = 0.0;
    if (workers_ == nullptr) {
      for (std::size_t e = 0; e < edges_; ++e) result += visit(e, AllPositions{});
      return result;
    }
    share([&](const EdgePart& part) {
      for (const EdgePart::Member& member : part.edges) {
        const double term = visit(at(member.edge), part);
        if (member.is_counted) terms_[at(member.edge)] = term;
      }
    });
    for (const double term : terms_) result += term;
    return result;
  }

 private:
  template <class Task>
  void share(const Task& task) const {
    for_ranges(workers_, parts_.size(), 1, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) task(parts_[i]);
    });
  }

  Workers* workers_;
  std::size_t edges_;
  std::vector<EdgePart> parts_;  ///< none without workers
  std::vector<double> terms_;    ///< by edge
};

}  // namespace fathom::pose_graph
