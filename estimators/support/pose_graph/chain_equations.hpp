#pragma once

#include <array>
#include <optional>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/chains.hpp"
#include "estimators/support/pose_graph/normal_equations.hpp"
#include "estimators/support/sparse/panel_memory.hpp"

namespace fathom::pose_graph {

/// A keyframe of a chain that is eliminated, H = L D Lᵀ of its block. B and E are its blocks with
/// the end of the chain that its side begins at and with the keyframe that is eliminated next, both
/// as D⁻¹ L⁻¹ times them.
struct EliminatedKeyframe {
  double B[3][4];  ///< last column: D⁻¹ L⁻¹ g
  double E[3][4];  ///< last column: the step of the keyframe
  double l10, l20, l21;
  double inverse[3];  ///< of D
};

/// What the elimination of a chain leaves beside its PairTerms.
struct ChainSums {
  double decrease = 0.0;       ///< gᵀ H⁻¹ g of what is eliminated
  double gradient_norm = 0.0;  ///< largest element of the gradient of ½F there
  /// Of the gradient of ½F at its ends, before the elimination.
  std::array<double, 3> g_from{};
  std::array<double, 3> g_to{};
  int negative_pivots = 0;
  bool is_sound = true;  ///< no pivot is zero or not a number
};

/// NormalEquations of a graph with chains. The keyframes of a chain are eliminated along it, from
/// both ends to its middle, without a pattern; what that leaves at the ends of the chains is added
/// to the equations of the graph without them.
class ChainEquations {
 public:
  /// `left`: equations of chains.edges(). Both must outlive it. `workers` eliminate where it is
  /// worth it; the results are the same.
  ChainEquations(const ChainGraph& chains, NormalEquations& left, Workers* workers = nullptr);

  /// As of NormalEquations. Keyframes that the graph leaves out must be where their steps lead;
  /// they add nothing.
  double linearise(std::span<const Node> nodes, Hessian hessian, double damping = 0.0);
  double differentiate(std::span<const Node> nodes);
  bool factorise(sparse::Inertia inertia = sparse::Inertia::any) {
    const bool is_possible = inertia == sparse::Inertia::any || negative_pivots_ == 0;
    return are_sound_ && is_possible && left_.factorise(inertia);
  }
  int negative_pivots() const { return negative_pivots_ + left_.negative_pivots(); }
  void solve_step();
  /// As of NormalEquations; the keyframes of chains are eliminated at the estimate itself.
  int iterations_worth_a_factor() const { return left_.iterations_worth_a_factor(); }
  std::optional<double> solve_near(std::span<const Node> nodes, int most_iterations);
  double predicted_decrease() const { return decrease_ + left_.predicted_decrease(); }
  /// At the estimate of the last differentiate().
  double gradient_norm() const;
  /// Keyframes that the graph leaves out follow.
  void move(std::span<const Node> from, std::vector<Node>& to) const;
  bool step_is_small(std::span<const Node> nodes, double tolerance) const;

  /// As PositionProblem::solve.
  bool follow_headings(std::vector<Node>& nodes);

 private:
  std::span<const Node> ends(std::span<const Node> nodes);
  void eliminate(std::span<const Node> nodes, Hessian hessian, double damping);
  void substitute_back_from(const std::vector<double>& left_step);
  std::span<const EliminatedKeyframe> inside(std::size_t chain) const;
  double decrease() const;

  const ChainGraph& graph_;
  NormalEquations& left_;
  std::span<const ChainGraph::Chain> chains_;  ///< those that have an end
  std::vector<std::size_t> begins_;            ///< of each, among the keyframes inside
  Workers* workers_;
  sparse::PanelMemory memory_;
  EliminatedKeyframe* inside_;
  std::vector<PairTerms> terms_;  ///< by chain
  std::vector<ChainSums> sums_;   ///< by chain
  std::vector<Node> at_ends_;
  std::vector<std::array<double, 3>> end_steps_;  ///< of the keyframes of the graph
  double decrease_ = 0.0;
  int negative_pivots_ = 0;
  bool are_sound_ = true;
};

}  // namespace fathom::pose_graph
