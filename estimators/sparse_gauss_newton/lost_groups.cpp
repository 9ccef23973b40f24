#include "estimators/sparse_gauss_newton/lost_groups.hpp"

#include <algorithm>
#include <cstdlib>
#include <map>
#include <numeric>

namespace fathom::sparse_gauss_newton {
namespace {

constexpr int kNeighbours = 5;  // keyframes
// Two measurements and the motions between them differ, not one: four times the variance.
constexpr double kSlack = 4.0;

Pose pose_of(const Node& node) {
  return {node.x, node.y, node.theta};
}

// Whether what `a` measured, carried over to the keyframes of `b`, is what `b` measured.
bool agree(const Edge& a, const Edge& b, std::span<const Node> nodes, double squared_scale) {
  const auto pose = [&](int k) { return pose_of(nodes[at(k)]); };
  const Pose back = between(pose(b.from), pose(a.from));
  const Pose on = between(pose(a.to), pose(b.to));
  const Pose expected = compose(compose(back, {a.x, a.y, a.theta}), on);
  const Node from = make_node(0.0, 0.0, 0.0);
  const Node to = make_node(expected.x, expected.y, expected.theta);
  return linearise_edge(b, from, to).cost <= kSlack * squared_scale;
}

class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t find(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) { parent_[find(a)] = find(b); }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

std::vector<std::vector<std::size_t>> lost_groups(const LoopGraph& graph,
                                                  const Consensus& consensus,
                                                  std::span<const Node> nodes) {
  std::vector<std::size_t> lost;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (graph.is_loop[e] != 0 && consensus.weights[e] == 0.0) lost.push_back(e);
  }
  const auto from = [&graph](std::size_t e) { return graph.edges[e].from; };
  std::stable_sort(lost.begin(), lost.end(),
                   [&](std::size_t a, std::size_t b) { return from(a) < from(b); });
  Sets sets(lost.size());
  for (std::size_t i = 0; i < lost.size(); ++i) {
    const Edge& a = graph.edges[lost[i]];
    for (std::size_t j = i + 1; j < lost.size(); ++j) {
      const Edge& b = graph.edges[lost[j]];
      if (b.from - a.from > kNeighbours) break;
      if (std::abs(b.to - a.to) > kNeighbours || sets.find(i) == sets.find(j)) continue;
      if (agree(a, b, nodes, consensus.squared_scale)) sets.join(i, j);
    }
  }
  std::map<std::size_t, std::vector<std::size_t>> by_root;
  for (std::size_t i = 0; i < lost.size(); ++i) by_root[sets.find(i)].push_back(lost[i]);
  std::vector<std::vector<std::size_t>> groups;
  for (auto& [root, group] : by_root) {
    if (group.size() > 1) groups.push_back(std::move(group));
  }
  std::stable_sort(groups.begin(), groups.end(),
                   [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return groups;
}

}  // namespace fathom::sparse_gauss_newton
