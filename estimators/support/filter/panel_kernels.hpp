#pragma once

#include <Eigen/Core>

namespace fathom::filter {

/// The triangle of a PackedCovariance is cut into panels of so many rows, each column-major: the
/// rows of a column lie side by side. A multiple of three, as the blocks are, and of a cache line.
inline constexpr Eigen::Index kPanelRows = 24;

/// Rows of right-hand sides and sums that belong to columns of a panel: three numbers and a fourth
/// that is never used, so that one register holds them.
inline constexpr Eigen::Index kPadded = 4;

/// A stretch of columns of one panel, times B of three columns: from both sides, as every number of
/// the triangle stands for two of the matrix. Both sums are added to.
struct PanelSweep {
  const double* panel = nullptr;  ///< kPanelRows × columns
  Eigen::Index columns = 0;
  const double* row_B = nullptr;     ///< kPanelRows × 3, column-major: B at the panel's rows
  const double* column_B = nullptr;  ///< kPadded numbers per column: B at the panel's columns
  double* row_sums = nullptr;        ///< panel · B(columns), kPanelRows × 3, column-major
  double* column_sums = nullptr;     ///< panelᵀ · B(rows), kPadded numbers per column
};

/// Does a sweep for all three columns of B, or for its first two.
void sweep(const PanelSweep& work, int columns_of_B);

/// panel −= R Cᵀ with R (kPanelRows × rank) at `V_rows` and C (columns × rank) at `V_columns`, and
/// the numbers from one column of each to its next.
void downdate_panel(double* panel, Eigen::Index columns, const double* V_rows,
                    Eigen::Index row_stride, const double* V_columns, Eigen::Index column_stride,
                    Eigen::Index rank);

}  // namespace fathom::filter
