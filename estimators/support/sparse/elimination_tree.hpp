#pragma once

#include <cstddef>
#include <vector>

#include "estimators/support/sparse/ordering.hpp"

namespace fathom::sparse {

/// Parents in the elimination tree of a graph, by positions in an order of elimination (Liu 1990,
/// with path compression); −1 for a root.
std::vector<int> elimination_tree(const Adjacency& graph, const std::vector<int>& order,
                                  const std::vector<int>& position);

/// The positions in postorder: every subtree contiguous, children in their order.
std::vector<int> postorder(const std::vector<int>& parent);

/// The 3×3 blocks of a dense panel: a lower triangle of `width` columns and `height` rows below it.
std::size_t blocks_of(int width, int height);

/// Whether merging a child into its parent pays, where that makes `zeros` explicit zero blocks in a
/// panel of `blocks` with `width` columns (relaxed supernodes, Ashcraft and Grimes 1989).
bool is_worth_merging(int width, std::size_t zeros, std::size_t blocks);

}  // namespace fathom::sparse
