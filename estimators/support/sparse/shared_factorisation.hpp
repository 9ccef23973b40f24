#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include "estimators/support/sparse/factorisation.hpp"

namespace fathom::sparse {

/// How far a factorisation by several threads has come.
struct FactorisationProgress {
  FactorisationProgress(const TreeCut& cut, int threads)
      : claims(cut.steps.size()), done(threads) {}

  bool has_failed() const { return failed_at != std::numeric_limits<int>::max(); }

  std::atomic<int> next_branch{0};
  std::vector<std::atomic<int>> claims;  ///< by step of the top: chunks of rows taken so far
  std::atomic<int> diagonals{0};         ///< steps of the top whose diagonal blocks are done
  /// The step in which it has failed; −1: in a branch.
  std::atomic<int> failed_at{std::numeric_limits<int>::max()};
  std::atomic<int> negative{0};
  Barrier done;  ///< the branches, then a step of the top
};

/// What one of several threads does of a factorisation. Each number gets the same products
/// subtracted in the same order as by one thread, by the same kernel, so it has the same bits.
template <int B>
struct SharedFactorisation {
  Factorisation<B> own;
  FactorisationProgress& progress;
  int threads;

  /// Rows of a chunk are a multiple of so many blocks, so that no tile but the panel's last reads
  /// past the end of its chunk, where another thread may write.
  static constexpr int kChunkUnit = kTileRows;
  /// So many rows below the diagonal block belong to its chunk, for its tiles to read.
  static constexpr int kGuard = 4;

  const TreeCut& cut() const { return own.symbolic.cut; }
  const Supernode& supernode(int place) const {
    return own.symbolic.supernodes[at(cut().top[at(place)])];
  }
  double* panel(const Supernode& s) const { return own.panels + s.panel * kBlockNumbers<B>; }
  double* sign(const Supernode& s) const { return own.signs + at(s.first * B); }
  bool has_failed_before(int step) const { return progress.failed_at < step; }

  // Rows of a panel in chunks: the first has the diagonal block.
  struct Chunks {
    int first_end;
    int rows;
    int all;

    int count() const { return 1 + (all - first_end + rows - 1) / rows; }
    int begin(int chunk) const { return chunk == 0 ? 0 : first_end + (chunk - 1) * rows; }
    int end(int chunk) const { return std::min(all, first_end + chunk * rows); }
  };

  FATHOM_INLINE Chunks chunks_of(const Supernode& t) const {
    const int all = t.panel_rows();
    if (!is_large(t) || t.width * B < kTileRows) return {all, kChunkUnit, all};
    const int share = (t.height - kGuard) / (3 * threads);
    return {t.width + kGuard, (share / kChunkUnit + 1) * kChunkUnit, all};
  }

  // Subtracts what all sources have for block rows [begin, end) of a supernode of the top.
  FATHOM_INLINE void pull(int place, const Supernode& t, int begin, int end) const {
    const Symbolic& symbolic = own.symbolic;
    for (int p = cut().pull_start[at(place)]; p < cut().pull_start[at(place) + 1]; ++p) {
      const Pull& from = cut().pulls[at(p)];
      const Supernode& s = symbolic.supernodes[at(from.source)];
      const Update& u = symbolic.updates[at(from.update)];
      const int* places = symbolic.places.data() + u.places;
      const int* stop = places + (s.height - u.begin);
      const int* first = begin == 0 ? places : std::lower_bound(places, stop, begin);
      const int* last = end == t.panel_rows() ? stop : std::lower_bound(first, stop, end);
      if (first == last) continue;
      own.update(s, u, panel(s), s.panel_rows() * B, sign(s),
                 u.begin + static_cast<int>(first - places),
                 u.begin + static_cast<int>(last - places));
    }
  }

  // Rows below the diagonal block, once that is done.
  FATHOM_INLINE void factor_lower_chunk(int step, const Chunks& chunks, int chunk) const {
    const int place = cut().steps[at(step)];
    const Supernode& t = supernode(place);
    const int begin = chunks.begin(chunk);
    const int end = chunks.end(chunk);
    pull(place, t, begin, end);
    wait_until([&] { return progress.diagonals.load(std::memory_order_acquire) > step; });
    if (has_failed_before(step + 1)) return;
    own.factor_below(t, panel(t), t.panel_rows() * B, begin * B, end * B, sign(t));
  }

  // The diagonal block and the rows beside it; or whole supernodes, of a step of one thread.
  FATHOM_INLINE void factor_first_chunk(int step, const Chunks& chunks) {
    const bool is_shared = chunks.count() > 1;
    bool is_done = true;
    for (int place = cut().steps[at(step)]; place < cut().steps[at(step) + 1] && is_done; ++place) {
      const Supernode& t = supernode(place);
      const int stride = t.panel_rows() * B;
      pull(place, t, 0, is_shared ? chunks.first_end : t.panel_rows());
      is_done = own.factor_panel(t, panel(t), stride, is_shared ? t.width * B : stride, sign(t));
      if (is_done) own.invert_diagonal(t, panel(t), stride);
    }
    if (!is_done) progress.failed_at = step;
    progress.diagonals.store(step + 1, std::memory_order_release);
    if (!is_done || !is_shared) return;
    const Supernode& t = supernode(cut().steps[at(step)]);
    own.factor_below(t, panel(t), t.panel_rows() * B, t.width * B, chunks.first_end * B, sign(t));
  }

  FATHOM_INLINE void factor_branches() {
    const int count = static_cast<int>(cut().branches.size());
    for (int i = progress.next_branch++; i < count && !has_failed_before(0);
         i = progress.next_branch++) {
      const Branch& branch = cut().branches[at(cut().by_work[at(i)])];
      if (!own.run(branch.begin, branch.end)) progress.failed_at = -1;
    }
    progress.done.wait();
  }

  FATHOM_INLINE void factor_step(int step) {
    const Chunks chunks = chunks_of(supernode(cut().steps[at(step)]));
    std::atomic<int>& next = progress.claims[at(step)];
    for (int chunk = next++; chunk < chunks.count(); chunk = next++) {
      if (chunk == 0) {
        factor_first_chunk(step, chunks);
      } else {
        factor_lower_chunk(step, chunks, chunk);
      }
    }
    progress.done.wait();
  }

  // All threads leave at the same step, so that none waits for one that has left.
  FATHOM_INLINE bool run() {
    factor_branches();
    const int count = static_cast<int>(cut().steps.size()) - 1;
    for (int step = 0; step < count && !has_failed_before(step); ++step) factor_step(step);
    progress.negative += own.negative;
    return true;
  }
};

}  // namespace fathom::sparse
