#include "estimators/sparse_gauss_newton/lost_groups.hpp"

#include "estimators/sparse_gauss_newton/loop_groups.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

// A loop's ends and what it measured, written the way round that is asked for.
struct Written {
  int from = 0;
  int to = 0;
  Pose motion;
};

Written written(const Edge& edge, bool forward) {
  const Pose motion{edge.x, edge.y, edge.theta};
  if (is_forward(edge) == forward) return {edge.from, edge.to, motion};
  return {edge.to, edge.from, inverse(motion)};
}

// Whether what `a` measured, carried over to the keyframes of `b`, is what `b` measured.
bool agree(const Edge& a, const Edge& b, std::span<const Node> nodes, double limit) {
  const auto pose = [&](int k) { return pose_of(nodes[at(k)]); };
  const Written as_b = written(a, is_forward(b));
  const Pose back = between(pose(b.from), pose(as_b.from));
  const Pose on = between(pose(as_b.to), pose(b.to));
  const Pose expected = compose(compose(back, as_b.motion), on);
  const Node from = make_node(0.0, 0.0, 0.0);
  const Node to = make_node(expected.x, expected.y, expected.theta);
  return linearise_edge(b, from, to).cost <= limit;
}

}  // namespace

std::vector<std::vector<std::size_t>> lost_groups(const LoopGraph& graph,
                                                  const Consensus& consensus,
                                                  std::span<const Node> nodes,
                                                  const LoopJudgement& judgement) {
  std::vector<std::size_t> lost;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const bool is_registration = graph.is_loop[e] != 0 && graph.rank(e) == 3;
    if (is_registration && consensus.weights[e] == 0.0) lost.push_back(e);
  }
  const double limit = judgement.lost_group_slack * consensus.squared_scales.registration;
  const auto belong = [&](const Edge& a, const Edge& b) { return agree(a, b, nodes, limit); };
  auto groups = group_loops(graph.edges, std::move(lost), judgement.group_reach, belong);
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

}  // namespace fathom::sparse_gauss_newton
