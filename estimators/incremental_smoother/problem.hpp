#pragma once

#include <algorithm>
#include <vector>

#include "estimators/incremental_smoother/loop_weights.hpp"
#include "estimators/incremental_smoother/pictures.hpp"
#include "estimators/incremental_smoother/variables.hpp"

namespace fathom::incremental_smoother {

/// What a correction of a variable counts, in squared sigmas per m² and rad² (of errors: of the
/// first two of them and of the third), as far as its own measurements tell.
struct Weight {
  double position = 0.0;
  double heading = 0.0;
};

/// The estimate and the measurements, and which of them belong to a keyframe.
class Problem {
 public:
  explicit Problem(const Node& origin, const RobustLoss& loss = {}, bool folds_singles = true)
      : nodes{origin},
        weights{{Weight{}}},
        loops(loss),
        pictures(folds_singles),
        saved_in_{{-1}},
        first_{-1} {}

  int size() const { return static_cast<int>(nodes.size()); }
  int edge_count() const { return static_cast<int>(edges.size()); }
  std::size_t error_count() const { return pictures.errors.size(); }

  Node& node(int v) { return is_errors(v) ? pictures.errors[at(~v)] : nodes[at(v)]; }
  const Node& node(int v) const { return is_errors(v) ? pictures.errors[at(~v)] : nodes[at(v)]; }

  void add_node(const Node& node) {
    nodes.push_back(node);
    weights.poses.emplace_back();
    saved_in_.poses.push_back(-1);
    first_.push_back(-1);
  }

  /// `shared`: what it tells of its errors, if that is not to be left out.
  void add_edge(const Edge& edge, bool is_loop = false, int rank = 3,
                const SharedErrors* shared = nullptr) {
    const int e = edge_count();
    edges.push_back(edge);
    loops.add(is_loop, rank);
    next_.push_back(first_[at(edge.from)]);
    next_.push_back(first_[at(edge.to)]);
    first_[at(edge.from)] = 2 * e;
    first_[at(edge.to)] = 2 * e + 1;
    if (shared != nullptr) {
      pictures.add(*shared, edges);
      grow_errors();
    }
    weigh(edges.back());
  }

  /// As Pictures::unfold. The poses of the edge that was folded must be up to date.
  void unfold(int keyframe) {
    const int e = pictures.folded_edge(keyframe);
    weigh(edges[at(e)], -1.0);
    pictures.unfold(keyframe, edges, nodes);
    grow_errors();
    weigh(edges[at(e)]);
  }

  /// Takes the newest edges back, down to `count` of them.
  void forget_edges(int count) {
    pictures.forget(count, edges);
    while (edge_count() > count) {
      const Edge& edge = edges.back();
      first_[at(edge.to)] = next_.back();
      next_.pop_back();
      first_[at(edge.from)] = next_.back();
      next_.pop_back();
      edges.pop_back();
    }
    loops.forget(edge_count());
    weights.fill({});
    weights.errors.assign(error_count(), kPrior);
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

  /// use(variable) for the errors at the ends of an edge.
  template <class Use>
  static void for_each_errors(const Edge& edge, Use use) {
    if (edge.shared == nullptr) return;
    if (edge.shared->from.node >= 0) use(errors_of(edge.from));
    if (edge.shared->to.node >= 0) use(errors_of(edge.to));
  }

  /// use(variable) for all that an edge is about.
  template <class Use>
  static void for_each_end(const Edge& edge, Use use) {
    use(edge.from);
    use(edge.to);
    for_each_errors(edge, use);
  }

  /// use(edge index, keyframe at the other end) for each edge of a variable.
  template <class Use>
  void for_each_edge_of(int v, Use use) const {
    if (!is_errors(v)) return for_each_edge(v, use);
    for_each_edge(keyframe_of(v), [&](int e, int other) {
      if (edges[at(e)].shared != nullptr) use(e, other);
    });
  }

  /// use(variable) for each that an edge links with this one; some more than once.
  template <class Use>
  void for_each_linked(int v, Use use) const {
    const int keyframe = keyframe_of(v);
    for_each_edge(keyframe, [&](int e, int other) {
      const Edge& edge = edges[at(e)];
      if (!is_errors(v)) {
        use(other);
        for_each_errors(edge, use);
      } else if (edge.shared != nullptr) {
        use(other);
        for_each_errors(edge, [&](int end) {
          if (end != v) use(end);
        });
      }
    });
    if (is_errors(v)) use(keyframe);
  }

  /// From here on nodes are saved before they change, so that they can be restored.
  void begin_update() {
    ++update_;
    saved_.clear();
  }

  /// Where a variable was when the update began; the first to say so counts.
  void save(int v, const Node& node) {
    if (saved_in_[v] == update_) return;
    saved_in_[v] = update_;
    saved_.push_back({v, node});
  }

  void restore_saved() {
    for (const Saved& saved : saved_) node(saved.variable) = saved.node;
  }

  std::vector<Node> nodes;
  std::vector<Edge> edges;
  ByVariable<Weight> weights;  ///< of loops that count in full
  LoopWeights loops;
  Pictures pictures;

 private:
  static constexpr Weight kPrior{1.0, 1.0};

  void grow_errors() {
    weights.errors.resize(error_count(), kPrior);
    saved_in_.errors.resize(error_count(), -1);
  }

  void weigh(const Edge& edge, double sign = 1.0) {
    const double position = sign * 0.5 * (edge.W[0] + edge.W[3]);
    const double heading = sign * edge.W[5];
    const double lever_m2 = edge.x * edge.x + edge.y * edge.y;
    weights[edge.from].position += position;
    weights[edge.from].heading += heading + lever_m2 * position;
    weights[edge.to].position += position;
    weights[edge.to].heading += heading;
    if (edge.shared == nullptr) return;
    const Eigen::Matrix3d W = sign * pose_graph::full(edge.W);
    for (const pose_graph::SharedEnds::End* end : {&edge.shared->from, &edge.shared->to}) {
      if (end->node < 0) continue;
      Weight& weight = weights[errors_of(end->node)];
      const Eigen::Matrix3d H = end->G.transpose() * W * end->G;
      weight.position += 0.5 * (H(0, 0) + H(1, 1));
      weight.heading += H(2, 2);
    }
  }

  struct Saved {
    int variable;
    Node node;
  };
  std::vector<Saved> saved_;
  ByVariable<long> saved_in_;  ///< the last update that saved it
  long update_ = 0;

  // A list of ends: 2 e is the begin of edge e, 2 e + 1 its end.
  std::vector<int> first_;
  std::vector<int> next_;
};

}  // namespace fathom::incremental_smoother
