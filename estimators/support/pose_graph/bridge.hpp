#pragma once

#include <span>

#include "estimators/support/pose_graph/edge.hpp"
#include "fathom/estimation/relative_estimator.hpp"

namespace fathom::pose_graph {

/// Nodes move as the bridge says, and the edges of holes, of which nothing is measured, follow. As
/// those are met exactly, before and after, and the others are relative, F stays.
void bridge(const Bridge& bridge, std::span<Edge> edges, std::span<Node> nodes);

}  // namespace fathom::pose_graph
