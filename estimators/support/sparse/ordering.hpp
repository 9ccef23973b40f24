#pragma once

#include <vector>

#include "estimators/support/sparse/index.hpp"
#include "fathom/core/workers.hpp"

namespace fathom::sparse {

/// The neighbours of each of the nodes 0 … n − 1 of an undirected graph, each once, without itself.
struct Adjacency {
  std::vector<int> start;  ///< n + 1
  std::vector<int> neighbours;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

struct Link {
  int a = 0;
  int b = 0;
};

/// Links between nodes 0 … n − 1; repeated ones count once.
Adjacency adjacency_of(int n, const std::vector<Link>& links);

/// Which nodes an ordering may take before those with more neighbours.
enum class ChainElimination { on, off };

/// How the nodes that are no chain are ordered.
enum class Ordering {
  minimum_degree,    ///< approximate minimum degree (Amestoy, Davis, Duff 1996)
  nested_dissection  ///< SCOTCH (Pellegrini, Roman and Amestoy 2000), where the build has it
};

/// An order of elimination with little fill. Nodes with one or two neighbours left go first, again
/// and again: whole chains between loops, then what their removal turns into chains. That makes no
/// fill but a link between the ends, and costs O(n). `workers` dissect; the order is the same.
std::vector<int> elimination_order(Adjacency graph, ChainElimination chains,
                                   Ordering ordering = Ordering::minimum_degree,
                                   Workers* workers = nullptr);

}  // namespace fathom::sparse
