#pragma once

#include <algorithm>
#include <atomic>

#include "estimators/support/sparse/substitution.hpp"

namespace fathom::sparse {

/// How far a substitution by several threads has come.
struct SubstitutionProgress {
  explicit SubstitutionProgress(int threads) : done(threads) {}

  std::atomic<int> next_forward{0};
  std::atomic<int> next_backward{0};
  Barrier done;
};

/// What one of several threads does of a substitution. What a branch subtracts from the top is
/// kept until the sources before it have subtracted theirs, so each sum has the order, and the
/// bits, that it has with one thread.
template <int B>
struct SharedSubstitution {
  Substitution<B> own;
  SubstitutionProgress& progress;
  double* deferred;  ///< B numbers for each of TreeCut::deferred_rows
  bool is_first;     ///< this thread does the top

  const TreeCut& cut() const { return own.symbolic.cut; }
  const Supernode& supernode(int i) const { return own.symbolic.supernodes[at(i)]; }

  FATHOM_INLINE void forward(const Branch& branch) const {
    double* kept = deferred + branch.deferred * B;
    for (int i = branch.begin; i < branch.end; ++i) {
      const Supernode& s = supernode(i);
      const int inside = rows_inside(own.symbolic, s, branch.end);
      own.solve_own(s, own.gathered);
      own.subtract(s, own.gathered, 0, inside);
      kept = std::copy(own.gathered + inside * B, own.gathered + s.height * B, kept);
    }
  }

  // What a branch has kept.
  FATHOM_INLINE void subtract_kept(const Branch& branch) const {
    const double* kept = deferred + branch.deferred * B;
    for (int i = branch.begin; i < branch.end; ++i) {
      const Supernode& s = supernode(i);
      const int inside = rows_inside(own.symbolic, s, branch.end);
      own.subtract(s, kept, inside, s.height);
      kept += at((s.height - inside) * B);
    }
  }

  FATHOM_INLINE void solve_top() const {
    std::size_t branch = 0;
    for (const int s : cut().top) {
      while (branch < cut().branches.size() && cut().branches[branch].begin < s) {
        subtract_kept(cut().branches[branch++]);
      }
      own.forward(supernode(s));
    }
    own.apply_signs();
    for (std::size_t i = cut().top.size(); i > 0; --i) own.backward(supernode(cut().top[i - 1]));
  }

  FATHOM_INLINE bool run() {
    const int count = static_cast<int>(cut().branches.size());
    for (int i = progress.next_forward++; i < count; i = progress.next_forward++) {
      forward(cut().branches[at(cut().by_work[at(i)])]);
    }
    progress.done.wait();
    if (is_first) solve_top();
    progress.done.wait();
    for (int i = progress.next_backward++; i < count; i = progress.next_backward++) {
      const Branch& branch = cut().branches[at(cut().by_work[at(i)])];
      for (int s = branch.end; s > branch.begin; --s) own.backward(supernode(s - 1));
    }
    return true;
  }
};

}  // namespace fathom::sparse
