#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/sparse_gauss_newton/loop_judgement.hpp"

namespace fathom::sparse_gauss_newton {

/// In a first guess of weights, that of a loop of which nothing is known.
inline constexpr double kNewLoop = -1.0;

/// c² of `truncated`: the squared residual, left out, at which a loop weighs one half. How well
/// registrations agree says how far their σ are off, and nothing of those of other measurements.
struct SquaredScales {
  double registration = 0.0;  ///< the given one, the default, or less
  double partial = 0.0;       ///< of what measures part of a motion: the given one or the default

  double of_rank(int rank) const {
    return (rank == 3 ? registration : partial) * squared_scale_share(LossKind::truncated, rank);
  }
};

/// Which loops agree, and the least squares of those.
struct Consensus {
  SolveResult solved;
  std::vector<double> weights;  ///< by edge
  SquaredScales squared_scales;
};

/// How to look for a consensus.
struct ConsensusOptions {
  LoopJudgement judgement;
  /// Absent: the default, or less where the registrations agree better than they say.
  std::optional<double> squared_scale;
  SolveLimits limits;  ///< of the last solve
};

/// Judges every loop by what all others say of it (leave_one_out), again and again: the worst are
/// rejected until none contradicts the rest, those outside that agree with it are readmitted, then
/// groups of neighbours that the rest contradicts as a whole (group_chi2) are rejected, and at the
/// end each weighs 1 up to half the squared scale, 0 from one and a half times it on, and in
/// between falls linearly. A weight that rests on the others' word does not confirm itself.
///
/// `weights` is the first guess, `nodes` where it is valid; both may be far off in part.
Consensus find_consensus(const LoopGraph& graph, std::vector<double> weights,
                         std::vector<Node>& nodes, const ConsensusOptions& options);

/// F of the loops kept and the scale for each that is not: the less, the better a consensus.
double truncated_cost(const LoopGraph& graph, std::span<const double> weights,
                      std::span<const Node> nodes, const SquaredScales& squared_scales);

}  // namespace fathom::sparse_gauss_newton
