#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/solver.hpp"

namespace fathom::pose_graph {

/// The pattern and the equations of all nodes of a graph.
struct WholeEquations {
  WholeEquations(std::span<const Edge> edges, std::size_t nodes, Workers* workers)
      : symbolic(analyse_graph(edges, static_cast<int>(nodes), workers)),
        equations(symbolic, edges) {}

  sparse::Symbolic symbolic;
  NormalEquations equations;
};

/// Steps on a graph: by the elimination of its chains where it has any, else by the equations of
/// all nodes, which are made when they are first asked for.
class GraphEquations {
 public:
  /// The edges must outlive it.
  GraphEquations(std::span<const Edge> edges, std::size_t nodes, Workers* workers)
      : edges_(edges), nodes_(nodes), workers_(workers) {}

  /// `left`: of chains.edges(). Both must outlive it.
  void eliminate_chains(const ChainGraph& chains, GraphEquations& left);

  WholeEquations& whole();

  /// As minimise.
  SolveResult minimise_from(std::vector<Node>& nodes, const SolveLimits& limits, Hessian first);

  /// One step that is exact in the positions, whatever they were, and corrects the headings by what
  /// the measured positions say of them. Where the equations have no solution, the nodes stay.
  void take_measured_step(std::vector<Node>& nodes);

 private:
  std::span<const Edge> edges_;
  std::size_t nodes_;
  Workers* workers_;
  const ChainGraph* chain_graph_ = nullptr;
  std::optional<ChainEquations> chains_;
  std::unique_ptr<WholeEquations> whole_;
};

}  // namespace fathom::pose_graph
