#pragma once

#include <cstddef>
#include <vector>

#include "estimators/support/sparse/ordering.hpp"
#include "estimators/support/sparse/tree_cut.hpp"
#include "fathom/core/workers.hpp"

namespace fathom::sparse {

/// Columns of a supernode at most. A wider one, at the top of a large graph, is several that follow
/// each other: each is still in the cache when it is subtracted from the next ones.
inline constexpr int kWidestSupernode = 32;

/// Consecutive columns of the factor with (nearly) the same rows below them, kept as one dense
/// panel. Rows and columns count blocks.
struct Supernode {
  int first = 0;    ///< first column
  int width = 0;    ///< columns
  int rows = 0;     ///< begin of the rows below the columns, in Symbolic::rows
  int height = 0;   ///< how many rows below
  int updates = 0;  ///< begin of its updates, in Symbolic::updates
  int update_count = 0;
  std::size_t panel = 0;  ///< blocks in the panels before it

  int panel_rows() const { return width + height; }
};

/// A keyframe of a chain: loops for wider ones cost more than its arithmetic.
inline bool is_narrow(const Supernode& s) {
  return s.width == 1 && s.height <= 2;
}
/// Whether it has loops of its own. Of single numbers a product would be contracted with the
/// difference that takes it, which the loops for wider ones do not.
template <int B>
bool is_narrow(const Supernode& s) {
  return B > 1 && is_narrow(s);
}

/// What a supernode subtracts from one later supernode.
struct Update {
  int target = 0;
  int begin = 0;  ///< the source's rows [begin, end) are columns of the target
  int end = 0;
  int places = 0;  ///< begin in Symbolic::places: rows of the target's panel for [begin, height)
};

/// The pattern of a sparse Cholesky factor L of a symmetric matrix of blocks, and where each
/// product of it goes. Made once per pattern; the size of a block plays no part.
///
/// Columns are merged into supernodes where the rows agree, and where merging costs few explicit
/// zeros (Davis, *Direct Methods for Sparse Linear Systems*, 2006; Ashcraft and Grimes 1989).
struct Symbolic {
  std::vector<int> position;  ///< of a node in the order of elimination
  std::vector<int> node;      ///< its inverse
  std::vector<Supernode> supernodes;
  std::vector<int> supernode_of;  ///< of a position
  std::vector<int> rows;
  std::vector<Update> updates;
  std::vector<int> places;
  std::size_t panel_blocks = 0;
  /// Who factors and substitutes; null: the calling thread alone. The results are the same.
  Workers* workers = nullptr;
  TreeCut cut;  ///< for `workers`

  int size() const { return static_cast<int>(node.size()); }

  /// The block in row `row` and column `column` (positions, row ≥ column) of the panel of
  /// `column`'s supernode: its row there.
  int panel_row(int row, const Supernode& supernode) const;
};

/// What a matrix may be.
enum class Inertia { any, positive };

/// How many of the rows below a supernode are columns of supernodes before `end`.
int rows_inside(const Symbolic& symbolic, const Supernode& s, int end);

/// Of fewer blocks in all panels, waking threads costs more than they do.
inline constexpr std::size_t kLeastSharedBlocks = 30000;

/// `workers` get the work where it is worth it, that is, from `least_shared` blocks on.
Symbolic analyse(const Adjacency& graph, ChainElimination chains = ChainElimination::on,
                 Workers* workers = nullptr, std::size_t least_shared = kLeastSharedBlocks);

}  // namespace fathom::sparse
