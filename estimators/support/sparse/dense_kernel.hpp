#pragma once

#include <cstddef>

#include "fathom/core/cpu.hpp"

/// The arithmetic of the factorisation, inlined into functions compiled for the processor at hand.
namespace fathom::sparse {

#define FATHOM_INLINE [[gnu::always_inline]] inline

/// Four numbers; the compiler splits them where the processor takes fewer.
using Four [[gnu::vector_size(32)]] = double;
/// The same at any address, behind a pointer alone: clang takes a member or an array of it for
/// aligned like Four, and lays it out for 8 bytes.
using FourAnywhere [[gnu::vector_size(32), gnu::aligned(8), gnu::may_alias]] = double;

inline constexpr int kTileRows = 12;
/// A tile reads up to so many numbers past the rows that it is asked for.
inline constexpr std::size_t kReadAhead = 16;

/// out (kTileRows × B) = A (4 V rows × depth, columns `stride` apart) · b (depth × B, by rows).
template <int B, int V>
FATHOM_INLINE void multiply_tile(const double* A, int stride, const double* b, int depth,
                                 double* out) {
  Four sum[V][B] = {};
  for (int k = 0; k < depth; ++k) {
    const FourAnywhere* column =
        reinterpret_cast<const FourAnywhere*>(A + static_cast<std::size_t>(k) * stride);
    for (int v = 0; v < V; ++v) {
      for (int j = 0; j < B; ++j) sum[v][j] += column[v] * b[k * B + j];
    }
  }
  for (int j = 0; j < B; ++j) {
    for (int v = 0; v < V; ++v) {
      *reinterpret_cast<FourAnywhere*>(out + static_cast<std::size_t>(j * kTileRows + 4 * v)) =
          sum[v][j];
    }
  }
}

/// The same for `rows` ≤ kTileRows rows, as few at a time as will do.
template <int B>
FATHOM_INLINE void multiply_rows(int rows, const double* A, int stride, const double* b, int depth,
                                 double* out) {
  if (rows <= 4) {
    multiply_tile<B, 1>(A, stride, b, depth, out);
  } else if (rows <= 8) {
    multiply_tile<B, 2>(A, stride, b, depth, out);
  } else {
    multiply_tile<B, 3>(A, stride, b, depth, out);
  }
}

template <class Task>
bool run_plain(Task& task) {
  return task.run();
}

template <class Task>
FATHOM_FOR_AVX2 bool run_wide(Task& task) {
  return task.run();
}

/// task.run(), which must be FATHOM_INLINE with all that it calls, compiled for the processor's
/// vector unit where that is worth it.
template <class Task>
bool run_for_processor(Task& task) {
  return has_avx2() ? run_wide(task) : run_plain(task);
}

}  // namespace fathom::sparse
