#include "estimators/support/sparse/tree_cut.hpp"

#include <algorithm>
#include <numeric>

#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::sparse {
namespace {

// A thread has so many branches to choose from, so that all end at about the same time. More would
// leave more to the top.
constexpr double kBranchesPerThread = 8.0;

// A factorisation is shared where that lowers the arithmetic that has to wait for each other to
// this share.
constexpr double kWorthIt = 0.8;
// Block columns and rows below that a supernode needs for threads to share its rows.
constexpr int kLargeWidth = 4;
constexpr int kLargeHeight = 32;

// Products of a panel with its own rows: half of width · rows².
double multiplications_of(const Supernode& s) {
  double sum = 0.0;
  for (int column = 0; column < s.width; ++column) {
    const double below = s.panel_rows() - column;
    sum += 0.5 * below * (below + 1.0);
  }
  return sum;
}

// The supernode that holds the first row below; −1 for a root.
int parent_of(const Symbolic& symbolic, const Supernode& s) {
  return s.height > 0 ? symbolic.supernode_of[at(symbolic.rows[at(s.rows)])] : -1;
}

// Which supernodes have more than `share` of all work in their subtrees.
std::vector<char> find_top(const Symbolic& symbolic, double share, std::vector<double>& work) {
  for (const Supernode& s : symbolic.supernodes) work.push_back(multiplications_of(s));
  const double largest = share * std::accumulate(work.begin(), work.end(), 0.0);
  std::vector<double> subtree = work;
  std::vector<char> is_top;
  for (std::size_t i = 0; i < subtree.size(); ++i) {
    is_top.push_back(subtree[i] > largest ? 1 : 0);
    const int parent = parent_of(symbolic, symbolic.supernodes[i]);
    if (parent >= 0) subtree[at(parent)] += subtree[i];
  }
  return is_top;
}

// How many of the rows below a branch's supernodes lie outside it.
std::size_t rows_outside(const Symbolic& symbolic, const Branch& branch) {
  std::size_t count = 0;
  for (int i = branch.begin; i < branch.end; ++i) {
    const Supernode& s = symbolic.supernodes[at(i)];
    count += at(s.height - rows_inside(symbolic, s, branch.end));
  }
  return count;
}

// Subtrees that follow each other make one branch as long as that is small.
void gather_branches(const Symbolic& symbolic, const std::vector<char>& is_top,
                     const std::vector<double>& work, double share, TreeCut& cut) {
  const double largest = share * std::accumulate(work.begin(), work.end(), 0.0);
  std::vector<double> sums;
  bool is_open = false;
  const int count = static_cast<int>(symbolic.supernodes.size());
  for (int root = 0, begin = 0; root < count; ++root) {
    const int parent = parent_of(symbolic, symbolic.supernodes[at(root)]);
    if (is_top[at(root)] != 0) {
      cut.top.push_back(root);
      begin = root + 1;
      is_open = false;
    } else if (parent < 0 || is_top[at(parent)] != 0) {
      const double sum = std::accumulate(work.begin() + begin, work.begin() + root + 1, 0.0);
      if (!is_open || sums.back() + sum > largest) {
        cut.branches.push_back({begin, root + 1, 0});
        sums.push_back(0.0);
        is_open = true;
      }
      sums.back() += sum;
      cut.branches.back().end = begin = root + 1;
    }
  }
  cut.by_work.resize(sums.size());
  std::iota(cut.by_work.begin(), cut.by_work.end(), 0);
  std::stable_sort(cut.by_work.begin(), cut.by_work.end(),
                   [&](int a, int b) { return sums[at(a)] > sums[at(b)]; });
}

void list_steps(const Symbolic& symbolic, TreeCut& cut) {
  bool is_open = false;
  for (std::size_t place = 0; place < cut.top.size(); ++place) {
    const bool is_alone = is_large(symbolic.supernodes[at(cut.top[place])]);
    if (is_alone || !is_open) cut.steps.push_back(static_cast<int>(place));
    is_open = !is_alone;
  }
  cut.steps.push_back(static_cast<int>(cut.top.size()));
}

// The arithmetic that no number of threads can do at the same time, and a share of the rest.
bool is_worth_it(const Symbolic& symbolic, const TreeCut& cut, const std::vector<double>& work,
                 int threads) {
  double alone = 0.0;
  for (const int s : cut.top) alone += is_large(symbolic.supernodes[at(s)]) ? 0.0 : work[at(s)];
  const double all = std::accumulate(work.begin(), work.end(), 0.0);
  return alone + (all - alone) / threads < kWorthIt * all;
}

void list_pulls(const Symbolic& symbolic, TreeCut& cut) {
  std::vector<int> place(symbolic.supernodes.size(), -1);
  for (std::size_t i = 0; i < cut.top.size(); ++i) place[at(cut.top[i])] = static_cast<int>(i);
  cut.pull_start.assign(cut.top.size() + 1, 0);
  for (const Update& update : symbolic.updates) {
    if (place[at(update.target)] >= 0) ++cut.pull_start[at(place[at(update.target)]) + 1];
  }
  std::partial_sum(cut.pull_start.begin(), cut.pull_start.end(), cut.pull_start.begin());
  std::vector<int> next(cut.pull_start.begin(), cut.pull_start.end() - 1);
  cut.pulls.resize(at(cut.pull_start.back()));
  for (std::size_t source = 0; source < symbolic.supernodes.size(); ++source) {
    const Supernode& s = symbolic.supernodes[source];
    for (int u = s.updates; u < s.updates + s.update_count; ++u) {
      const int target = place[at(symbolic.updates[at(u)].target)];
      if (target >= 0) cut.pulls[at(next[at(target)]++)] = {static_cast<int>(source), u};
    }
  }
}

}  // namespace

bool is_large(const Supernode& s) {
  return s.width >= kLargeWidth && s.height >= kLargeHeight;
}

double multiplications_of(const Symbolic& symbolic) {
  double sum = 0.0;
  for (const Supernode& s : symbolic.supernodes) sum += multiplications_of(s);
  return sum;
}

TreeCut cut_tree(const Symbolic& symbolic, int threads) {
  const double share = 1.0 / (kBranchesPerThread * threads);
  TreeCut cut;
  std::vector<double> work;
  work.reserve(symbolic.supernodes.size());
  const std::vector<char> is_top = find_top(symbolic, share, work);
  gather_branches(symbolic, is_top, work, share, cut);
  if (!is_worth_it(symbolic, cut, work, threads)) return {};
  list_steps(symbolic, cut);
  for (Branch& branch : cut.branches) {
    branch.deferred = cut.deferred_rows;
    cut.deferred_rows += rows_outside(symbolic, branch);
  }
  list_pulls(symbolic, cut);
  return cut;
}

}  // namespace fathom::sparse
