#pragma once

#include <atomic>
#include <limits>
#include <vector>

#include "estimators/support/sparse/factorisation.hpp"

namespace fathom::sparse {

/// How far a factorisation by several threads has come.
struct FactorisationProgress {
  FactorisationProgress(const TreeCut& cut, int threads) : claims(cut.top.size()), done(threads) {}

  bool has_failed() const { return failed_at != std::numeric_limits<int>::max(); }

  std::atomic<int> next_branch{0};
  std::vector<std::atomic<int>> claims;  ///< by place in the top: chunks of rows taken so far
  std::atomic<int> diagonals{0};         ///< of the top: how many diagonal blocks are done
  /// Where in the top it has failed; −1: in a branch.
  std::atomic<int> failed_at{std::numeric_limits<int>::max()};
  std::atomic<int> negative{0};
  Barrier done;  ///< the branches, then a supernode of the top
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
  bool has_failed_before(int place) const { return progress.failed_at < place; }

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
    if (t.height < kGuard || t.width * B < kTileRows) return {all, kChunkUnit, all};
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
      own.update(s, u, own.panels + s.panel * kBlockNumbers<B>, s.panel_rows() * B,
                 own.signs + at(s.first * B), u.begin + static_cast<int>(first - places),
                 u.begin + static_cast<int>(last - places));
    }
  }

  FATHOM_INLINE void factor_chunk(int place, const Supernode& t, const Chunks& chunks, int chunk) {
    const int begin = chunks.begin(chunk);
    const int end = chunks.end(chunk);
    pull(place, t, begin, end);
    double* panel = own.panels + t.panel * kBlockNumbers<B>;
    const int stride = t.panel_rows() * B;
    double* sign = own.signs + at(t.first * B);
    if (chunk > 0) {
      wait_until([&] { return progress.diagonals.load(std::memory_order_acquire) > place; });
      if (!has_failed_before(place + 1)) {
        own.factor_below(t, panel, stride, begin * B, end * B, sign);
      }
      return;
    }
    const bool is_whole = end == t.panel_rows();
    const int rows = is_whole ? end : t.width;
    const bool is_done = own.factor_panel(t, panel, stride, rows * B, sign);
    if (is_done) own.invert_diagonal(t, panel, stride);
    if (!is_done) progress.failed_at = place;
    progress.diagonals.store(place + 1, std::memory_order_release);
    if (is_done && !is_whole) own.factor_below(t, panel, stride, rows * B, end * B, sign);
  }

  FATHOM_INLINE void factor_branches() {
    const int count = static_cast<int>(cut().branches.size());
    for (int i; (i = progress.next_branch.fetch_add(1)) < count && !has_failed_before(0);) {
      const Branch& branch = cut().branches[at(cut().by_work[at(i)])];
      if (!own.run(branch.begin, branch.end)) progress.failed_at = -1;
    }
    progress.done.wait();
  }

  // All threads leave at the same place, so that none waits for one that has left.
  FATHOM_INLINE bool run() {
    factor_branches();
    const int count = static_cast<int>(cut().top.size());
    for (int place = 0; place < count && !has_failed_before(place); ++place) {
      const Supernode& t = own.symbolic.supernodes[at(cut().top[at(place)])];
      const Chunks chunks = chunks_of(t);
      for (int chunk; (chunk = progress.claims[at(place)].fetch_add(1)) < chunks.count();) {
        factor_chunk(place, t, chunks, chunk);
      }
      progress.done.wait();
    }
    progress.negative += own.negative;
    return !has_failed_before(count);
  }
};

}  // namespace fathom::sparse
