#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "estimators/support/pose_graph/solver.hpp"

namespace fathom::pose_graph {

/// Minimises F from dead reckoning, the registrations with a weight that rises from nearly nothing
/// to 1 (graduation, a homotopy): each minimum is the start of the next one. `nodes` becomes the
/// result; on failure it stays as it was. Steps are the edges between nodes that follow each other.
SolveResult solve_graduated(std::span<const Edge> edges, std::vector<Node>& nodes,
                            const SolveLimits& limits, Workers* workers = nullptr);

/// For a graph that grows and is solved from its last estimate: looks for a lower minimum where an
/// update may have missed it.
class MinimumSearch {
 public:
  /// Whether an update raised F, which was `before`, by more than consistent registrations do, but
  /// with a chance of one in ten thousand. Covariances are taken to be too small by F per degree of
  /// freedom, of all registrations so far, where that is above 1. After fruitless searches 3, 15,
  /// 63, … such updates go without: false loops raise F, too.
  bool is_due(double before, double after, std::size_t registrations);

  /// Solves from the starts of Start::automatic and by graduation. Where one ends lower than `cost`
  /// by more than the tolerance, `nodes` becomes it.
  std::optional<SolveResult> run(std::span<const Edge> edges, std::vector<Node>& nodes, double cost,
                                 const SolveLimits& limits, Workers* workers = nullptr);

 private:
  double registrations_ = 0.0;
  int to_leave_out_ = 0;  ///< after the last search
  int left_out_ = 0;      ///< since then
};

}  // namespace fathom::pose_graph
