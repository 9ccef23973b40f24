#include "estimators/support/filter/panel_kernels.hpp"

#include <cstring>

#include "fathom/core/cpu.hpp"

namespace fathom::filter {
namespace {

// Numbers side by side, by the vector extension of g++ and clang++. Every loop over registers is
// unrolled, so that the sums of a column stay in them.
struct TwoLanes {
  using Doubles = double __attribute__((vector_size(16)));
};
struct FourLanes {
  using Doubles = double __attribute__((vector_size(32)));
};
struct EightLanes {
  using Doubles = double __attribute__((vector_size(64)));
};

template <class Doubles>
constexpr Eigen::Index kLanes = static_cast<Eigen::Index>(sizeof(Doubles) / sizeof(double));

template <class Doubles>
[[gnu::always_inline]] inline void load(const double* from, Doubles& to) {
  std::memcpy(&to, from, sizeof(to));
}

template <class Doubles>
[[gnu::always_inline]] inline void store(const Doubles& from, double* to) {
  std::memcpy(to, &from, sizeof(from));
}

// The memory is asked for what comes so many columns later, into the second-level cache: by itself
// it waits whenever a page ends, and with the first-level cache as the aim there are too few
// requests under way.
constexpr Eigen::Index kAhead = 64 * kPanelRows;
constexpr Eigen::Index kDoublesPerLine = 8;

template <int Columns>
[[gnu::always_inline]] inline void ask_for_later(const double* panel) {
#pragma GCC unroll 8
  for (Eigen::Index i = 0; i < Columns * kPanelRows; i += kDoublesPerLine) {
    __builtin_prefetch(panel + kAhead + i, 0, 2);
  }
}

// to[q] += sum of the lanes of sums[q], the fourth number of `to` being of no account.
[[gnu::always_inline]] inline void add_lanes(const FourLanes::Doubles (&sums)[3], double* to) {
  using Doubles = FourLanes::Doubles;
  const Doubles none{};
  const Doubles a = __builtin_shufflevector(sums[0], sums[1], 0, 4, 2, 6) +
                    __builtin_shufflevector(sums[0], sums[1], 1, 5, 3, 7);
  const Doubles b = __builtin_shufflevector(sums[2], none, 0, 4, 2, 6) +
                    __builtin_shufflevector(sums[2], none, 1, 5, 3, 7);
  Doubles total;
  load(to, total);
  total += __builtin_shufflevector(a, b, 0, 1, 4, 5) + __builtin_shufflevector(a, b, 2, 3, 6, 7);
  store(total, to);
}

[[gnu::always_inline]] inline void add_lanes(const TwoLanes::Doubles (&sums)[3], double* to) {
  for (int q = 0; q < 3; ++q) to[q] += sums[q][0] + sums[q][1];
}

// `Columns` columns of a panel at once, `Q` columns of B.
template <class Doubles, int Columns, int Q>
[[gnu::always_inline]] inline void sweep_columns(const double* panel, const PanelSweep& work,
                                                 const double* column_B, double* column_sums) {
  Doubles factor[Columns][Q];
  Doubles sums[Columns][3];
  ask_for_later<Columns>(panel);
#pragma GCC unroll 2
  for (int c = 0; c < Columns; ++c) {
#pragma GCC unroll 3
    for (int q = 0; q < 3; ++q) sums[c][q] = Doubles{};
#pragma GCC unroll 3
    for (int q = 0; q < Q; ++q) factor[c][q] = Doubles{} + column_B[kPadded * c + q];
  }
#pragma GCC unroll 12
  for (Eigen::Index r = 0; r < kPanelRows; r += kLanes<Doubles>) {
    Doubles P[Columns];
#pragma GCC unroll 2
    for (int c = 0; c < Columns; ++c) load(panel + kPanelRows * c + r, P[c]);
#pragma GCC unroll 3
    for (int q = 0; q < Q; ++q) {
      Doubles row_sum;
      Doubles B;
      load(work.row_sums + kPanelRows * q + r, row_sum);
      load(work.row_B + kPanelRows * q + r, B);
#pragma GCC unroll 2
      for (int c = 0; c < Columns; ++c) {
        row_sum += P[c] * factor[c][q];
        sums[c][q] += P[c] * B;
      }
      store(row_sum, work.row_sums + kPanelRows * q + r);
    }
  }
#pragma GCC unroll 2
  for (int c = 0; c < Columns; ++c) add_lanes(sums[c], column_sums + kPadded * c);
}

// Two columns at once: the sums of rows are fetched and put back half as often.
template <class Doubles, int Q>
[[gnu::always_inline]] inline void sweep_with(const PanelSweep& work) {
  const double* panel = work.panel;
  const double* column_B = work.column_B;
  double* column_sums = work.column_sums;
  Eigen::Index left = work.columns;
  for (; left >= 2; left -= 2) {
    sweep_columns<Doubles, 2, Q>(panel, work, column_B, column_sums);
    panel += 2 * kPanelRows;
    column_B += 2 * kPadded;
    column_sums += 2 * kPadded;
  }
  if (left == 1) sweep_columns<Doubles, 1, Q>(panel, work, column_B, column_sums);
}

// The factors of one downdate: see downdate_panel.
struct Factors {
  const double* rows;
  Eigen::Index row_stride;
  const double* columns;
  Eigen::Index column_stride;
  Eigen::Index rank;
};

template <class Doubles, int Columns>
[[gnu::always_inline]] inline void downdate_columns(double* panel, const Factors& V,
                                                    Eigen::Index column) {
  constexpr Eigen::Index kRegisters = kPanelRows / kLanes<Doubles>;
  Doubles P[Columns][kRegisters];
  ask_for_later<Columns>(panel);
#pragma GCC unroll 4
  for (int c = 0; c < Columns; ++c) {
#pragma GCC unroll 12
    for (Eigen::Index r = 0; r < kRegisters; ++r) {
      load(panel + kPanelRows * c + kLanes<Doubles> * r, P[c][r]);
    }
  }
  const double* rows = V.rows;
  const double* columns = V.columns + column;
  for (Eigen::Index k = 0; k < V.rank; ++k, rows += V.row_stride, columns += V.column_stride) {
    Doubles factor[Columns];
#pragma GCC unroll 4
    for (int c = 0; c < Columns; ++c) factor[c] = Doubles{} + columns[c];
#pragma GCC unroll 12
    for (Eigen::Index r = 0; r < kRegisters; ++r) {
      Doubles row;
      load(rows + kLanes<Doubles> * r, row);
#pragma GCC unroll 4
      for (int c = 0; c < Columns; ++c) P[c][r] -= row * factor[c];
    }
  }
#pragma GCC unroll 4
  for (int c = 0; c < Columns; ++c) {
#pragma GCC unroll 12
    for (Eigen::Index r = 0; r < kRegisters; ++r) {
      store(P[c][r], panel + kPanelRows * c + kLanes<Doubles> * r);
    }
  }
}

template <class Doubles, int Columns>
[[gnu::always_inline]] inline void downdate_with(double* panel, Eigen::Index columns,
                                                 const Factors& V) {
  Eigen::Index c = 0;
  for (; c + Columns <= columns; c += Columns) {
    downdate_columns<Doubles, Columns>(panel + kPanelRows * c, V, c);
  }
  for (; c < columns; ++c) downdate_columns<Doubles, 1>(panel + kPanelRows * c, V, c);
}

FATHOM_FOR_AVX2 void sweep_by_avx2(const PanelSweep& work, int columns_of_B) {
  if (columns_of_B == 2) {
    sweep_with<FourLanes::Doubles, 2>(work);
  } else {
    sweep_with<FourLanes::Doubles, 3>(work);
  }
}

FATHOM_FOR_AVX2 void downdate_by_avx2(double* panel, Eigen::Index columns, const Factors& V) {
  downdate_with<FourLanes::Doubles, 2>(panel, columns, V);
}

// More registers: more columns at once, and each row of V is fetched for all of them.
FATHOM_FOR_AVX512 void downdate_by_avx512(double* panel, Eigen::Index columns, const Factors& V) {
  downdate_with<EightLanes::Doubles, 4>(panel, columns, V);
}

}  // namespace

void sweep(const PanelSweep& work, int columns_of_B) {
  if (has_avx2()) return sweep_by_avx2(work, columns_of_B);
  if (columns_of_B == 2) return sweep_with<TwoLanes::Doubles, 2>(work);
  sweep_with<TwoLanes::Doubles, 3>(work);
}

void downdate_panel(double* panel, Eigen::Index columns, const double* V_rows,
                    Eigen::Index row_stride, const double* V_columns, Eigen::Index column_stride,
                    Eigen::Index rank) {
  const Factors V{V_rows, row_stride, V_columns, column_stride, rank};
  if (has_avx512()) return downdate_by_avx512(panel, columns, V);
  if (has_avx2()) return downdate_by_avx2(panel, columns, V);
  downdate_with<TwoLanes::Doubles, 1>(panel, columns, V);
}

}  // namespace fathom::filter
