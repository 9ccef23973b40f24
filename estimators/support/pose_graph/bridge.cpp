#include "estimators/support/pose_graph/bridge.hpp"

#include <algorithm>
#include <cstddef>

namespace fathom::pose_graph {

void bridge(const Bridge& bridge, std::span<Edge> edges, std::span<Node> nodes) {
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    if (!bridge.moves[k]) continue;
    const Pose moved = compose(bridge.motion, pose_of(nodes[k]));
    nodes[k] = make_node(moved.x, moved.y, moved.theta);
  }
  for (const std::size_t hole : bridge.holes) {
    if (bridge.moves[hole - 1] == bridge.moves[hole]) continue;
    const int to = static_cast<int>(hole);
    // The first edge that ends there is its step.
    const auto step = std::ranges::find_if(
        edges, [to](const Edge& edge) { return edge.from == to - 1 && edge.to == to; });
    const Pose met = between(pose_of(nodes[hole - 1]), pose_of(nodes[hole]));
    step->x = met.x;
    step->y = met.y;
    step->theta = met.theta;
  }
}

}  // namespace fathom::pose_graph
