#include "estimators/sparse_gauss_newton/lost_groups.hpp"

#include "estimators/sparse_gauss_newton/loop_groups.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

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

}  // namespace

std::vector<std::vector<std::size_t>> lost_groups(const LoopGraph& graph,
                                                  const Consensus& consensus,
                                                  std::span<const Node> nodes) {
  std::vector<std::size_t> lost;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    if (graph.is_loop[e] != 0 && consensus.weights[e] == 0.0) lost.push_back(e);
  }
  auto groups = group_loops(graph.edges, std::move(lost), [&](const Edge& a, const Edge& b) {
    return agree(a, b, nodes, consensus.squared_scale);
  });
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

}  // namespace fathom::sparse_gauss_newton
