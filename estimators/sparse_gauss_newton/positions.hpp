#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/sparse_gauss_newton/block_cholesky.hpp"
#include "estimators/sparse_gauss_newton/edge.hpp"

namespace fathom::sparse_gauss_newton {

/// The positions that minimise F with the headings as they are: linear least squares, two unknowns
/// a keyframe. Where a long stretch of the trajectory has to turn, a step that is straight in all
/// coordinates stretches it; headings first and positions after them follow the arc.
class PositionProblem {
 public:
  /// Symbolic and edges must outlive it. Of a loss the weights count, as they are at first.
  PositionProblem(const Symbolic& symbolic, std::span<const Edge> edges, const EdgeLoss& loss);

  /// Solves for the positions of all keyframes but 0. False where it has no solution; then they
  /// stay as they were.
  bool solve(std::vector<Node>& nodes);

 private:
  std::span<const Edge> edges_;
  EdgeLoss loss_;
  BlockCholesky<2> factor_;
};

}  // namespace fathom::sparse_gauss_newton
