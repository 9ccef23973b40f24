#include "estimators/support/pose_graph/bridge.hpp"

namespace fathom::pose_graph {

void bridge(std::size_t node, const Pose& motion, std::span<Edge> edges, std::span<Node> nodes) {
  const int hole = static_cast<int>(node);
  // The first edge that ends there is its step.
  for (Edge& edge : edges) {
    if (edge.from != hole - 1 || edge.to != hole) continue;
    edge.x = motion.x;
    edge.y = motion.y;
    edge.theta = motion.theta;
    break;
  }
  const Pose before = pose_of(nodes[node]);
  const Pose after = compose(pose_of(nodes[node - 1]), motion);
  for (Node& n : nodes.subspan(node)) {
    const Pose moved = compose(after, between(before, pose_of(n)));
    n = make_node(moved.x, moved.y, moved.theta);
  }
}

}  // namespace fathom::pose_graph
