#include "estimators/support/sparse/symbolic.hpp"

#include <algorithm>
#include <utility>

#include "estimators/support/sparse/dense_kernel.hpp"
#include "estimators/support/sparse/elimination_tree.hpp"
#include "estimators/support/sparse/nested_dissection.hpp"

namespace fathom::sparse {
namespace {

std::vector<int> inverse_of(const std::vector<int>& permutation) {
  std::vector<int> inverse(permutation.size());
  for (std::size_t i = 0; i < permutation.size(); ++i) inverse[at(permutation[i])] = int(i);
  return inverse;
}

// The rows below each column, unsorted, one after the other.
struct Columns {
  std::vector<std::size_t> start;
  std::vector<int> rows;

  int count(int j) const { return static_cast<int>(start[at(j) + 1] - start[at(j)]); }
};

Columns fill_of(const Adjacency& graph, const Symbolic& result, const std::vector<int>& parent) {
  const int n = graph.size();
  Columns columns;
  columns.start.push_back(0);
  columns.rows.reserve(4 * graph.neighbours.size());
  std::vector<int> seen_by(at(n), -1);
  std::vector<int> last_child(at(n), -1);
  std::vector<int> sibling(at(n), -1);
  for (int j = 0; j < n; ++j) {
    const auto add = [&](int i) {
      if (i <= j || seen_by[at(i)] == j) return;
      seen_by[at(i)] = j;
      columns.rows.push_back(i);
    };
    const int v = result.node[at(j)];
    for (int p = graph.start[at(v)]; p < graph.start[at(v) + 1]; ++p) {
      add(result.position[at(graph.neighbours[at(p)])]);
    }
    for (int child = last_child[at(j)]; child >= 0; child = sibling[at(child)]) {
      for (std::size_t p = columns.start[at(child)]; p < columns.start[at(child) + 1]; ++p) {
        add(columns.rows[p]);
      }
    }
    columns.start.push_back(columns.rows.size());
    if (parent[at(j)] >= 0) {
      sibling[at(j)] = last_child[at(parent[at(j)])];
      last_child[at(parent[at(j)])] = j;
    }
  }
  return columns;
}

// As supernodes of at most kWidestSupernode columns; the rows below a piece begin with the columns
// of the next ones.
void append_in_pieces(const Supernode& merged, const Columns& columns, Symbolic& result) {
  const int end = merged.first + merged.width;
  const auto below = columns.rows.begin() + long(columns.start[at(end - 1)]);
  for (int first = merged.first; first < end;) {
    Supernode s;
    s.first = first;
    s.width = std::min(end - first, kWidestSupernode);
    s.height = end - (first + s.width) + merged.height;
    s.rows = static_cast<int>(result.rows.size());
    s.panel = result.panel_blocks;
    for (int row = first + s.width; row < end; ++row) result.rows.push_back(row);
    result.rows.insert(result.rows.end(), below, below + merged.height);
    std::sort(result.rows.end() - merged.height, result.rows.end());
    result.panel_blocks += at(s.width) * at(s.panel_rows());
    for (int j = first; j < first + s.width; ++j) {
      result.supernode_of[at(j)] = static_cast<int>(result.supernodes.size());
    }
    result.supernodes.push_back(s);
    first += s.width;
  }
}

void make_supernodes(const Columns& columns, const std::vector<int>& parent, Symbolic& result) {
  struct Merged {
    Supernode supernode;
    std::size_t filled = 0;  ///< blocks that are not explicit zeros
  };
  std::vector<Merged> stack;
  for (int j = 0; j < result.size(); ++j) {
    Merged next;
    next.supernode.first = j;
    next.supernode.width = 1;
    next.supernode.height = columns.count(j);
    next.filled = 1 + at(next.supernode.height);
    while (!stack.empty()) {
      const Merged& child = stack.back();
      const int last = child.supernode.first + child.supernode.width - 1;
      if (parent[at(last)] != next.supernode.first) break;
      const int width = child.supernode.width + next.supernode.width;
      const std::size_t blocks = blocks_of(width, next.supernode.height);
      const std::size_t filled = child.filled + next.filled;
      const bool fits = filled == blocks;
      const bool are_narrow = is_narrow(child.supernode) && is_narrow(next.supernode);
      if (!fits && (are_narrow || !is_worth_merging(width, blocks - filled, blocks))) break;
      next.supernode.first = child.supernode.first;
      next.supernode.width = width;
      next.filled = filled;
      stack.pop_back();
    }
    stack.push_back(next);
  }
  result.supernode_of.resize(at(result.size()));
  for (const Merged& merged : stack) append_in_pieces(merged.supernode, columns, result);
}

// For each supernode and each later one that it touches: where its rows lie there. Both lists of
// rows rise, so one walk along the target's finds them all.
void place_updates(Symbolic& result) {
  for (Supernode& s : result.supernodes) {
    s.updates = static_cast<int>(result.updates.size());
    const int* rows = result.rows.data() + s.rows;
    for (int begin = 0; begin < s.height;) {
      Update update;
      update.target = result.supernode_of[at(rows[begin])];
      const Supernode& t = result.supernodes[at(update.target)];
      update.begin = begin;
      update.places = static_cast<int>(result.places.size());
      int j = begin;
      for (; j < s.height && rows[j] < t.first + t.width; ++j) {
        result.places.push_back(rows[j] - t.first);
      }
      update.end = begin = j;
      const int* walk = result.rows.data() + t.rows;
      for (; j < s.height; ++j) {
        while (*walk != rows[j]) ++walk;
        result.places.push_back(t.width + static_cast<int>(walk - result.rows.data()) - t.rows);
      }
      result.updates.push_back(update);
    }
    s.update_count = static_cast<int>(result.updates.size()) - s.updates;
  }
}

// A tile that reads past the end of one thread's panels must not meet what another one writes.
void part_panels(Symbolic& result) {
  std::vector<char> is_end(result.supernodes.size(), 0);
  for (const int s : result.cut.top) is_end[at(s)] = 1;
  for (const Branch& branch : result.cut.branches) is_end[at(branch.end - 1)] = 1;
  std::size_t shift = 0;
  for (std::size_t i = 0; i < is_end.size(); ++i) {
    result.supernodes[i].panel += shift;
    if (is_end[i] != 0) shift += kReadAhead;
  }
  result.panel_blocks += shift;
}

Symbolic pattern_of(const Adjacency& graph, const std::vector<int>& order) {
  Symbolic result;
  const std::vector<int> tree = elimination_tree(graph, order, inverse_of(order));
  const std::vector<int> post = postorder(tree);
  const std::vector<int> new_place = inverse_of(post);
  std::vector<int> parent(tree.size(), -1);
  result.node.resize(order.size());
  for (std::size_t j = 0; j < order.size(); ++j) {
    const int old = post[j];
    result.node[j] = order[at(old)];
    if (tree[at(old)] >= 0) parent[j] = new_place[at(tree[at(old)])];
  }
  result.position = inverse_of(result.node);
  make_supernodes(fill_of(graph, result, parent), parent, result);
  return result;
}

// Where a factorisation by minimum degree takes at least twice as long as SCOTCH. A neighbour costs
// SCOTCH a microsecond or two, in which a factorisation makes 10⁴ multiply-adds, 27 of a block.
bool is_worth_dissecting(const Symbolic& symbolic, const Adjacency& graph) {
  constexpr double kMultiplicationsPerNeighbour = 740.0;
  return has_nested_dissection() &&
         multiplications_of(symbolic) >
             kMultiplicationsPerNeighbour * static_cast<double>(graph.neighbours.size());
}

void share_among(Workers* workers, std::size_t least_shared, Symbolic& result) {
  if (workers == nullptr || workers->size() < 2 || result.panel_blocks < least_shared) return;
  result.workers = workers;
  result.cut = cut_tree(result, workers->size());
  part_panels(result);
}

}  // namespace

int rows_inside(const Symbolic& symbolic, const Supernode& s, int end) {
  const int* rows = symbolic.rows.data() + s.rows;
  const Supernode& last = symbolic.supernodes[at(end - 1)];
  return static_cast<int>(std::lower_bound(rows, rows + s.height, last.first + last.width) - rows);
}

int Symbolic::panel_row(int row, const Supernode& s) const {
  if (row < s.first + s.width) return row - s.first;
  const auto begin = rows.begin() + s.rows;
  return s.width + static_cast<int>(std::lower_bound(begin, begin + s.height, row) - begin);
}

Symbolic analyse(const Adjacency& graph, ChainElimination chains, Workers* workers,
                 std::size_t least_shared) {
  Symbolic result = pattern_of(graph, elimination_order(graph, chains));
  if (is_worth_dissecting(result, graph)) {
    Symbolic dissected =
        pattern_of(graph, elimination_order(graph, chains, Ordering::nested_dissection, workers));
    if (multiplications_of(dissected) < multiplications_of(result)) result = std::move(dissected);
  }
  place_updates(result);
  share_among(workers, least_shared, result);
  return result;
}

}  // namespace fathom::sparse
