#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/panel_kernels.hpp"
#include "estimators/support/filter/scratch.hpp"

namespace fathom::filter {

/// P times the ends of one B, panel after panel of P's triangle: see
/// PackedCovariance::suffix_products. The blocks between two starts are a segment; every segment
/// has sums of its own, which are added up at the end.
class SuffixSums {
 public:
  /// Sums of rows first_row … size; they lie in `scratch`.
  SuffixSums(std::span<const Eigen::Index> starts, const Eigen::Ref<const Eigen::MatrixX3d>& B,
             Eigen::Index size, Eigen::Index first_row, Scratch& scratch);

  /// The part that a panel has in the rows of the stretch; `top` is its first row.
  void add_panel(const double* panel, Eigen::Index top, int columns_of_B);
  /// That in the rows above the stretch.
  void add_head(const double* panel, Eigen::Index top);
  /// With a single segment: returns what the panel left of its diagonal tile has in its own rows
  /// (kPanelRows×3), and adds what it has, transposed, in the rows of its columns.
  Eigen::MatrixX3d take_sides(const double* panel, Eigen::Index top);

  /// The rows from first_row on, as many as `product` has, and the first columns_of_B of the three
  /// columns of each start; the other is left as it is.
  void write(Eigen::Ref<Eigen::MatrixXd>& product, int columns_of_B = 3) const;

 private:
  using PanelRows = Eigen::Matrix<double, kPanelRows, 3>;
  PanelRows rows_of_segment(Eigen::Index top, std::size_t segment) const;
  void add_rows(const PanelRows& sums, Eigen::Index top, std::size_t segment);
  void add_columns(const double* panel, Eigen::Index top, std::size_t segment, Eigen::Index begin,
                   Eigen::Index end, int columns_of_B, PanelRows& row_sums);
  /// kPadded numbers for each row, from `row` on: of B, and of a segment's sums.
  double* B_at(Eigen::Index row) const { return B_ + kPadded * (row - base_); }
  double* sums_at(std::size_t segment, Eigen::Index row) const {
    return B_at(row) + kPadded * rows_ * static_cast<Eigen::Index>(segment + 1);
  }

  std::vector<Eigen::Index> cuts_;  ///< rows: of the starts, and the size
  Eigen::Index first_row_;
  Eigen::Index base_;  ///< the first row of the sums and of B: a panel's
  Eigen::Index rows_;  ///< of the sums and of B: whole panels
  double* B_;          ///< and the sums of each segment after it
};

}  // namespace fathom::filter
