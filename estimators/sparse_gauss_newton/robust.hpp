#pragma once

#include <optional>
#include <vector>

#include "estimators/sparse_gauss_newton/consensus.hpp"

namespace fathom::sparse_gauss_newton {

/// Where graduated non-convexity begins.
enum class Graduation {
  off,    ///< with the loss itself: the start is trusted
  convex  ///< with μ = 2 s_max / c², near least squares, and then 1.4 times less a step
};

struct RobustOptions {
  RobustLoss loss;
  /// c² as given; absent: as the loss has it by default, and `truncated` may use less.
  std::optional<double> squared_scale;
  Graduation graduation = Graduation::off;
};

struct RobustResult {
  SolveResult solved;
  std::vector<double> weights;  ///< by edge, of the last linearisation
};

/// Minimises Σ ρ(νᵀ W ν), the loss on loops alone, from `nodes` on, which become the result.
/// `from_scratch`: `nodes` is dead reckoning or a guess and the whole graph is new; else it is the
/// estimate so far, and no other hypothesis is tried. docs/robustness.md.
RobustResult solve_robust(const LoopGraph& graph, std::vector<Node>& nodes,
                          const RobustOptions& options, const SolveLimits& limits,
                          bool from_scratch);

}  // namespace fathom::sparse_gauss_newton
