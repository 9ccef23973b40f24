#include "estimators/support/pose_graph/edge_parts.hpp"

namespace fathom::pose_graph {
namespace {

// A thread has so many parts to choose from, so that all end at about the same time.
constexpr int kPartsPerThread = 4;

}  // namespace

EdgeParts::EdgeParts(const sparse::Symbolic& symbolic, std::span<const Edge> edges)
    : workers_(symbolic.workers), edges_(edges.size()) {
  if (workers_ == nullptr) return;
  const int count = kPartsPerThread * workers_->size();
  const int positions = symbolic.size() / count + 1;
  parts_.resize(at(count));
  terms_.resize(edges.size());
  for (int i = 0; i < count; ++i) {
    EdgePart& part = parts_[at(i)];
    part.begin = i * positions;
    part.end = part.begin + positions;
    // Most edges have both ends in one part.
    part.edges.reserve(edges.size() / at(count) * 5 / 4);
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const int edge = static_cast<int>(e);
    const int from = position_of(symbolic, edges[e].from);
    const int to = position_of(symbolic, edges[e].to);
    if (to >= 0) parts_[at(to / positions)].edges.push_back({edge, true});
    if (from >= 0 && (to < 0 || from / positions != to / positions)) {
      parts_[at(from / positions)].edges.push_back({edge, to < 0});
    }
  }
}

}  // namespace fathom::pose_graph
