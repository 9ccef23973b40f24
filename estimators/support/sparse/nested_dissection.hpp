#pragma once

#include <vector>

#include "estimators/support/sparse/ordering.hpp"
#include "fathom/core/workers.hpp"

namespace fathom::sparse {

/// Whether the build has it; without it orders are by minimum degree.
bool has_nested_dissection();

/// An order of elimination of all nodes; empty where SCOTCH fails, or is not there. It depends on
/// the graph alone, not on `workers`.
std::vector<int> nested_dissection_order(const Adjacency& graph, Workers* workers);

}  // namespace fathom::sparse
