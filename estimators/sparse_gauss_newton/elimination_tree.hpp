#pragma once

#include <vector>

#include "estimators/sparse_gauss_newton/ordering.hpp"

namespace fathom::sparse_gauss_newton {

/// Parents in the elimination tree of a graph, by positions in an order of elimination (Liu 1990,
/// with path compression); −1 for a root.
std::vector<int> elimination_tree(const Adjacency& graph, const std::vector<int>& order,
                                  const std::vector<int>& position);

/// The positions in postorder: every subtree contiguous, children in their order.
std::vector<int> postorder(const std::vector<int>& parent);

}  // namespace fathom::sparse_gauss_newton
