#pragma once

#include <cstddef>
#include <span>

#include "estimators/support/pose_graph/edge.hpp"

namespace fathom::pose_graph {

/// The step to `node`, a hole, becomes `motion`, and all nodes from there on move as one. As the
/// step's edge is met exactly, before and after, and the others are relative, F stays.
void bridge(std::size_t node, const Pose& motion, std::span<Edge> edges, std::span<Node> nodes);

}  // namespace fathom::pose_graph
