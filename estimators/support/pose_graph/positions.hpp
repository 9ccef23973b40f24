#pragma once

#include <optional>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge_parts.hpp"
#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::pose_graph {

/// The positions that minimise F with the headings as they are: linear least squares, two unknowns
/// a keyframe. Where a long stretch of the trajectory has to turn, a step that is straight in all
/// coordinates stretches it; headings first and positions after them follow the arc.
class PositionProblem {
 public:
  /// The factor of the poses lends its pattern and, while a solve lasts, its memory: its numbers
  /// are lost. It and the edges must outlive this. Of a loss the weights count, as they are at
  /// first.
  PositionProblem(sparse::BlockCholesky<3>& poses, std::span<const Edge> edges,
                  const EdgeLoss& loss);

  /// Solves for the positions of all keyframes but 0. False where it has no solution; then they
  /// stay as they were.
  bool solve(std::vector<Node>& nodes);

 private:
  void add_up(std::span<const Node> nodes);

  std::span<const Edge> edges_;
  EdgeLoss loss_;
  EdgeParts parts_;
  sparse::BlockCholesky<2> factor_;
  std::vector<double> step_;
};

}  // namespace fathom::pose_graph
