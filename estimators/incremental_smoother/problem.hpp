#pragma once

#include <vector>

#include "estimators/incremental_smoother/local_edge.hpp"
#include "estimators/sparse_gauss_newton/ordering.hpp"

namespace fathom::incremental_smoother {

using sparse_gauss_newton::at;

/// The estimate and the measurements, and which of them belong to a keyframe.
class Problem {
 public:
  explicit Problem(const Node& origin) : nodes{origin}, first_{-1} {}

  int size() const { return static_cast<int>(nodes.size()); }
  int edge_count() const { return static_cast<int>(edges.size()); }

  void add_node(const Node& node) {
    nodes.push_back(node);
    first_.push_back(-1);
  }

  void add_edge(const Edge& edge) {
    const int e = edge_count();
    edges.push_back(edge);
    next_.push_back(first_[at(edge.from)]);
    next_.push_back(first_[at(edge.to)]);
    first_[at(edge.from)] = 2 * e;
    first_[at(edge.to)] = 2 * e + 1;
  }

  /// Takes the newest edge back.
  void remove_edge() {
    const Edge& edge = edges.back();
    first_[at(edge.to)] = next_.back();
    next_.pop_back();
    first_[at(edge.from)] = next_.back();
    next_.pop_back();
    edges.pop_back();
  }

  /// use(edge index, keyframe at the other end) for each edge of a keyframe, the newest first.
  template <class Use>
  void for_each_edge(int keyframe, Use use) const {
    for (int i = first_[at(keyframe)]; i >= 0; i = next_[at(i)]) {
      const Edge& edge = edges[at(i / 2)];
      use(i / 2, i % 2 == 0 ? edge.to : edge.from);
    }
  }

  std::vector<Node> nodes;
  std::vector<Edge> edges;

 private:
  // A list of ends: 2 e is the begin of edge e, 2 e + 1 its end.
  std::vector<int> first_;
  std::vector<int> next_;
};

}  // namespace fathom::incremental_smoother
