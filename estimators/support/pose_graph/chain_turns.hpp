#pragma once

#include <span>
#include <vector>

#include "estimators/support/pose_graph/chains.hpp"

namespace fathom::pose_graph {

/// The turns of a graph without the keyframes of its chains: a chain measures the sum of the turns
/// of its steps, whose variances add. All edges must measure their turn (TurnGraph).
class ChainTurns {
 public:
  /// It must outlive this.
  explicit ChainTurns(const ChainGraph& chains);

  /// Between the keyframes that are left; of a chain only the turn is stated.
  std::span<const Edge> edges() const { return edges_; }
  /// Of all keyframes, the headings of those that are left.
  std::vector<double> left(std::span<const double> theta) const;
  /// Of those that are left, the least squares headings of all keyframes.
  std::vector<double> expanded(std::span<const double> theta) const;

 private:
  const ChainGraph& chains_;
  std::vector<Edge> edges_;
  std::vector<double> variances_;  ///< of each chain's turn
};

}  // namespace fathom::pose_graph
