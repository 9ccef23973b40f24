#pragma once

#include <span>
#include <vector>

#include "estimators/support/pose_graph/chains.hpp"
#include "estimators/support/pose_graph/headings.hpp"

namespace fathom::pose_graph {

/// The turns of a graph without the keyframes of its chains: a chain measures the sum of the turns
/// of its steps, whose variances add. All edges must measure their turn (TurnGraph).
class ChainTurns {
 public:
  /// It must outlive this.
  explicit ChainTurns(const ChainGraph& chains);

  /// Between the keyframes that are left; of a chain the sum of the turns of its steps. Which
  /// multiple of 2π that is depends on where they are rounded.
  std::span<const Edge> edges() const { return edges_; }

  /// HeadingProblem::solve of all keyframes, by that of edges(): each step is rounded along
  /// `theta`.
  std::vector<double> solve(HeadingProblem& left, std::span<const double> theta) const;

  /// How far a chain is from its turn at worst, each step rounded along `theta`.
  double worst_turn(std::span<const double> theta) const;

  /// Headings of all keyframes for those that are left: what a chain's end is off, within ±π, is
  /// distributed by the variances of its steps.
  std::vector<double> between(std::span<const double> left) const;

 private:
  const ChainGraph& chains_;
  std::vector<Edge> edges_;
  std::vector<double> variances_;  ///< of each chain's turn
};

}  // namespace fathom::pose_graph
