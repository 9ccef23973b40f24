// Where a solve may have ended in another minimum than the least.

#include <algorithm>
#include <utility>
#include <vector>

#include "estimators/sparse_gauss_newton/graph.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

// F over its degrees of freedom, in a whole graph. Consistent measurements have 1, covariances that
// are too small by a factor of 10 have 10; a wrong minimum of few loops has more.
constexpr double kMostCostShare = 10.0;

}  // namespace

SolveResult Graph::searched(const SolveResult& result, Start start, ExtendedGraph& solved,
                            const SolveLimits& limits) {
  if (!is_done(result.outcome)) return result;
  std::optional<SolveResult> found;
  if (!is_batch_) {
    const auto added =
        std::count(is_loop_.begin() + static_cast<std::ptrdiff_t>(solved_), is_loop_.end(), 1);
    const double before = std::exchange(cost_, result.cost);
    solved_ = edges_.size();
    if (!search_.is_due(before, result.cost, static_cast<std::size_t>(added))) return result;
    found = search_.run(solved.edges, solved.nodes, result.cost, limits, workers());
  } else if (start == Start::automatic) {
    const double dof = 3.0 * (static_cast<double>(edges_.size() + 1) - static_cast<double>(size()));
    if (!(dof > 0.0) || !(result.cost > kMostCostShare * dof)) return result;
    std::vector<Node> nodes = solved.nodes;
    const SolveResult other = pose_graph::solve_graduated(solved.edges, nodes, limits, workers());
    if (!is_done(other.outcome) || !(other.cost < result.cost * (1.0 - limits.tolerance))) {
      return result;
    }
    solved.nodes = std::move(nodes);
    found = other;
  }
  if (!found) return result;
  found->iterations += result.iterations;
  cost_ = found->cost;
  return *found;
}

}  // namespace fathom::sparse_gauss_newton
