#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/sparse_gauss_newton/consensus.hpp"

namespace fathom::sparse_gauss_newton {

/// Where graduated non-convexity begins.
enum class Graduation {
  off,    ///< with the loss itself: the start is trusted
  convex  ///< with μ = 2 s_max / c², near least squares, and then kGraduationStep times less a step
};

/// Of graduated non-convexity: that of Yang, Antonante, Tzoumas and Carlone 2020, section V, with
/// one solve of a few linearisations a step.
inline constexpr double kGraduationStep = 1.4;
inline constexpr SolveLimits kGraduationSolve{2, 1e-3};

struct RobustOptions {
  RobustLoss loss;
  /// c² as given; absent: as the loss has it by default, and `truncated` may use less.
  std::optional<double> squared_scale;
  Graduation graduation = Graduation::off;
  LoopJudgement judgement;  ///< of `truncated`
};

struct RobustResult {
  SolveResult solved;
  std::vector<double> weights;  ///< by edge, of the last linearisation
  std::optional<SquaredScales> squared_scales = std::nullopt;  ///< of `truncated`
};

/// Minimises Σ ρ(νᵀ W ν), the loss on loops alone, from `nodes` on, which become the result.
/// `known`: the weights of an estimate so far, that is, `nodes`, kNewLoop of new ones; then no
/// other hypothesis is tried. Empty: `nodes` is dead reckoning or a guess, and all is new.
/// docs/robustness.md.
RobustResult solve_robust(const LoopGraph& graph, std::vector<Node>& nodes,
                          const RobustOptions& options, const SolveLimits& limits,
                          std::span<const double> known = {});

}  // namespace fathom::sparse_gauss_newton
