#pragma once

#include <cstddef>
#include <vector>

namespace fathom::sparse {

struct Symbolic;

/// A row of subtrees of supernodes, or several that follow each other: [begin, end).
struct Branch {
  int begin = 0;
  int end = 0;
  /// Rows below its supernodes that lie in no branch: of all branches before it.
  std::size_t deferred = 0;
};

/// An update by its source.
struct Pull {
  int source = 0;
  int update = 0;  ///< in Symbolic::updates
};

/// A cut through the tree of supernodes, to work on parts of it at the same time. Below it are
/// branches, which share no column: what a branch subtracts outside itself goes to the top alone.
/// The top, which is closed upwards, is worked on supernode by supernode, several threads at each.
struct TreeCut {
  std::vector<Branch> branches;  ///< rising
  std::vector<int> by_work;      ///< branches, the one with most work first
  std::vector<int> top;          ///< supernodes, rising
  std::vector<int> pull_start;  ///< by place in `top`: begin of its updates in `pulls`; and the end
  std::vector<Pull> pulls;      ///< rising sources
  std::size_t deferred_rows = 0;  ///< of all branches
};

/// Cuts so that no branch is more than a small share of the arithmetic of a factorisation by so
/// many threads.
TreeCut cut_tree(const Symbolic& symbolic, int threads);

/// How much arithmetic the factorisation of scalars with this pattern is: multiplications and
/// additions. B³ times as much with blocks.
double multiplications_of(const Symbolic& symbolic);

}  // namespace fathom::sparse
