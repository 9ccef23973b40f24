#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "panel_kernels.hpp"

namespace fathom {

/// P times the ends of one B, panel after panel of P's triangle: see
/// FilterCovariance::suffix_products. The blocks between two starts are a segment; every segment
/// has sums of its own, which are added up at the end.
class SuffixSums {
 public:
  /// Sums of rows first_row … size.
  SuffixSums(std::span<const Eigen::Index> starts, const Eigen::MatrixX3d& B, Eigen::Index size,
             Eigen::Index first_row);

  /// The part that a panel has in the rows of the stretch; `top` is its first row.
  void add_panel(const double* panel, Eigen::Index top, int columns_of_B);
  /// That in the rows above the stretch.
  void add_head(const double* panel, Eigen::Index top);
  /// With a single segment: returns what the panel left of its diagonal tile has in its own rows
  /// (kPanelRows×3), and adds what it has, transposed, in the rows of its columns.
  Eigen::MatrixX3d take_sides(const double* panel, Eigen::Index top);

  /// (size − first_row) × 3 starts.
  Eigen::MatrixXd result() const;

 private:
  using PanelRows = Eigen::Matrix<double, kPanelRows, 3>;
  using Padded = Eigen::Matrix<double, kPadded, Eigen::Dynamic>;

  PanelRows rows_of_segment(Eigen::Index top, std::size_t segment) const;
  void add_rows(const PanelRows& sums, Eigen::Index top, std::size_t segment);
  void add_columns(const double* panel, Eigen::Index top, std::size_t segment, Eigen::Index begin,
                   Eigen::Index end, int columns_of_B, PanelRows& row_sums);

  Eigen::Index base_;  ///< the first row of `sums_` and `B_`: a panel's
  Eigen::Index first_row_;
  Eigen::Index size_;
  std::vector<Eigen::Index> cuts_;  ///< rows: of the starts, and the size
  Padded B_;
  std::vector<Padded> sums_;  ///< of each segment
};

}  // namespace fathom
