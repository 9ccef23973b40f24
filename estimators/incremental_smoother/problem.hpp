#pragma once

#include <algorithm>
#include <vector>

#include "estimators/incremental_smoother/loop_weights.hpp"
#include "estimators/support/sparse/ordering.hpp"

namespace fathom::incremental_smoother {

/// What a correction of a keyframe counts, in squared sigmas per m² and rad², as far as its own
/// measurements tell.
struct Weight {
  double position = 0.0;
  double heading = 0.0;
};

/// The estimate and the measurements, and which of them belong to a keyframe.
class Problem {
 public:
  explicit Problem(const Node& origin, const RobustLoss& loss = {})
      : nodes{origin}, weights(1), loops(loss), saved_in_{-1}, first_{-1} {}

  int size() const { return static_cast<int>(nodes.size()); }
  int edge_count() const { return static_cast<int>(edges.size()); }

  void add_node(const Node& node) {
    nodes.push_back(node);
    weights.emplace_back();
    saved_in_.push_back(-1);
    first_.push_back(-1);
  }

  void add_edge(const Edge& edge, bool is_loop = false, int rank = 3) {
    const int e = edge_count();
    edges.push_back(edge);
    loops.add(is_loop, rank);
    next_.push_back(first_[at(edge.from)]);
    next_.push_back(first_[at(edge.to)]);
    first_[at(edge.from)] = 2 * e;
    first_[at(edge.to)] = 2 * e + 1;
    weigh(edge);
  }

  /// Takes the newest edges back, down to `count` of them.
  void forget_edges(int count) {
    while (edge_count() > count) {
      const Edge& edge = edges.back();
      first_[at(edge.to)] = next_.back();
      next_.pop_back();
      first_[at(edge.from)] = next_.back();
      next_.pop_back();
      edges.pop_back();
    }
    loops.forget(edge_count());
    std::fill(weights.begin(), weights.end(), Weight{});
    for (const Edge& edge : edges) weigh(edge);
  }

  /// use(edge index, keyframe at the other end) for each edge of a keyframe, the newest first.
  template <class Use>
  void for_each_edge(int keyframe, Use use) const {
    for (int i = first_[at(keyframe)]; i >= 0; i = next_[at(i)]) {
      const Edge& edge = edges[at(i / 2)];
      use(i / 2, i % 2 == 0 ? edge.to : edge.from);
    }
  }

  /// From here on nodes are saved before they change, so that they can be restored.
  void begin_update() {
    ++update_;
    saved_.clear();
  }

  /// Where a keyframe was when the update began; the first to say so counts.
  void save(int keyframe, const Node& node) {
    if (saved_in_[at(keyframe)] == update_) return;
    saved_in_[at(keyframe)] = update_;
    saved_.push_back({keyframe, node});
  }

  void restore_saved() {
    for (const Saved& saved : saved_) nodes[at(saved.keyframe)] = saved.node;
  }

  std::vector<Node> nodes;
  std::vector<Edge> edges;
  std::vector<Weight> weights;  ///< by keyframe; of loops that count in full
  LoopWeights loops;

 private:
  void weigh(const Edge& edge) {
    const double position = 0.5 * (edge.W[0] + edge.W[3]);
    const double lever_m2 = edge.x * edge.x + edge.y * edge.y;
    weights[at(edge.from)].position += position;
    weights[at(edge.from)].heading += edge.W[5] + lever_m2 * position;
    weights[at(edge.to)].position += position;
    weights[at(edge.to)].heading += edge.W[5];
  }

  struct Saved {
    int keyframe;
    Node node;
  };
  std::vector<Saved> saved_;
  std::vector<long> saved_in_;  ///< by keyframe: the last update that saved it
  long update_ = 0;

  // A list of ends: 2 e is the begin of edge e, 2 e + 1 its end.
  std::vector<int> first_;
  std::vector<int> next_;
};

}  // namespace fathom::incremental_smoother
