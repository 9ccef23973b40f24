#pragma once

#include <cstddef>
#include <vector>

namespace fathom::sparse {

struct Supernode;
struct Symbolic;

/// Subtrees of supernodes that follow each other: [begin, end).
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
/// The top, which is closed upwards, is worked on step by step: a large supernode is a step that
/// several threads share, small ones that follow each other are a step of one thread.
struct TreeCut {
  std::vector<Branch> branches;  ///< rising
  std::vector<int> by_work;      ///< branches, the one with most work first
  std::vector<int> top;          ///< supernodes, rising
  std::vector<int> steps;        ///< places in `top` where a step begins; and the end
  std::vector<int> pull_start;  ///< by place in `top`: begin of its updates in `pulls`; and the end
  std::vector<Pull> pulls;      ///< rising sources
  std::size_t deferred_rows = 0;  ///< of all branches

  bool is_empty() const { return top.empty() && branches.empty(); }
};

/// Whether several threads can share the rows of a supernode of the top.
bool is_large(const Supernode& s);

/// Cuts so that no branch is more than a small share of the arithmetic of a factorisation by so
/// many threads. Nothing where there is little to share, as along a chain.
TreeCut cut_tree(const Symbolic& symbolic, int threads);

/// How much arithmetic the factorisation of scalars with this pattern is: multiplications and
/// additions. B³ times as much with blocks.
double multiplications_of(const Symbolic& symbolic);

}  // namespace fathom::sparse
