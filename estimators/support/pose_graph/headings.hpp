#pragma once

#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge_parts.hpp"
#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::pose_graph {

/// Headings alone: minimise Σ w wrap(θ_k − θ_i − δ)² over the edges, with the information w that
/// each has on the turn δ it measured. Linear as soon as the multiples of 2π are chosen, so one
/// factorisation serves all choices (Carlone, Aragues, Castellanos and Bona 2014, LAGO).
class HeadingProblem {
 public:
  /// Both must outlive it.
  HeadingProblem(const sparse::Symbolic& symbolic, std::span<const Edge> edges);

  /// Rounds at these headings, solves, and returns the solution; `theta` need not be wrapped.
  /// With headings composed along the odometry it is LAGO with the odometry as spanning tree.
  /// Where the information does not determine the headings they stay as they were.
  /// `given`: residuals of the first edges, rounded elsewhere.
  std::vector<double> solve(std::span<const double> theta, std::span<const double> given = {});

 private:
  std::span<const Edge> edges_;
  EdgeParts parts_;
  std::vector<double> weights_;
  sparse::BlockCholesky<1> factor_;
  bool is_solvable_ = false;
};

/// By how much a heading differs at most.
double largest_turn(std::span<const double> from, std::span<const double> to);

}  // namespace fathom::pose_graph
