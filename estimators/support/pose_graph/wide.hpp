#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/batch.hpp"

/// Graphs whose measurements differ so much in their information (InformationSpread) that the sums
/// of the normal equations lose what the weak ones say.
namespace fathom::pose_graph {

/// Whether the normal equations at an estimate carry all measurements: whether each pivot of their
/// factor is more than rounding.
bool sums_keep_digits(std::span<const Edge> edges, std::span<const Node> nodes);

/// Minimises F by Gauss-Newton steps from the whitened rows (NormalEquations::solve_rows), halved
/// until F does not rise. It starts where solve_batch ends with what the strong measurements say
/// cut down to what normal equations carry, and where that does not converge, from the given
/// estimate. On failure `nodes` stays as it was.
SolveResult solve_wide(std::span<const Edge> edges, std::vector<Node>& nodes, Start start,
                       const SolveLimits& limits, Workers* workers = nullptr);

}  // namespace fathom::pose_graph
