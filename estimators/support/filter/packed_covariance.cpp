#include "estimators/support/filter/packed_covariance.hpp"

#include <algorithm>

#include "estimators/support/filter/panel_kernels.hpp"
#include "estimators/support/filter/suffix_sums.hpp"

namespace fathom::filter {
namespace {

using Tile = Eigen::Map<Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<kPanelRows>>;
using ConstTile =
    Eigen::Map<const Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<kPanelRows>>;

Eigen::Index panel_of(Eigen::Index row) {
  return row / kPanelRows;
}

Eigen::Index top_of(std::size_t panel) {
  return static_cast<Eigen::Index>(panel) * kPanelRows;
}

}  // namespace

std::vector<std::size_t> PackedCovariance::panels_from(Eigen::Index row, PassOrder order) const {
  std::vector<std::size_t> panels;
  for (auto p = static_cast<std::size_t>(panel_of(row)); p < panels_.size(); ++p) {
    panels.push_back(p);
  }
  if (order == PassOrder::backward) std::reverse(panels.begin(), panels.end());
  return panels;
}

double* PackedCovariance::element(Eigen::Index row, Eigen::Index column) {
  return panels_[static_cast<std::size_t>(panel_of(row))] + kPanelRows * column + row % kPanelRows;
}

const double* PackedCovariance::element(Eigen::Index row, Eigen::Index column) const {
  return panels_[static_cast<std::size_t>(panel_of(row))] + kPanelRows * column + row % kPanelRows;
}

void PackedCovariance::append(const Eigen::Matrix3d& covariance) {
  if (size_ % kPanelRows == 0) {
    panels_.push_back(memory_.take(static_cast<std::size_t>(kPanelRows * (size_ + kPanelRows))));
  }
  Tile(element(size_, size_), 3, 3) = covariance.selfadjointView<Eigen::Lower>();
  size_ += 3;
}

void PackedCovariance::append(const Eigen::Matrix3Xd& cross, const Eigen::Matrix3d& covariance) {
  const Eigen::Index row = size_;
  append(covariance);
  Tile(element(row, 0), 3, row) = cross;
  const Eigen::Index tile = panel_of(row) * kPanelRows;
  Tile(element(tile, row), row - tile, 3) = cross.rightCols(row - tile).transpose();
}

void PackedCovariance::replace(Eigen::Index i, const Eigen::Matrix3d& covariance) {
  Eigen::MatrixX3d column = Eigen::MatrixX3d::Zero(size_, 3);
  column.middleRows<3>(3 * i) = covariance;
  replace(i, column);
}

void PackedCovariance::replace(Eigen::Index i, const Eigen::MatrixX3d& column) {
  const Eigen::Index own = 3 * i;
  const Eigen::Index tile = panel_of(own) * kPanelRows;
  Tile(element(own, 0), 3, own) = column.topRows(own).transpose();
  if (own > tile) Tile(element(tile, own), own - tile, 3) = column.middleRows(tile, own - tile);
  for (Eigen::Index row = own + 3; row < size_;) {
    const Eigen::Index panel = panel_of(row) * kPanelRows;
    const Eigen::Index rows = std::min(panel + kPanelRows, size_) - row;
    Tile(element(row, own), rows, 3) = column.middleRows(row, rows);
    // The tile on the diagonal has both triangles.
    if (panel == tile) Tile(element(own, row), 3, rows) = column.middleRows(row, rows).transpose();
    row += rows;
  }
  Tile(element(own, own), 3, 3) = column.middleRows<3>(own);
}

Eigen::Matrix3d PackedCovariance::block(Eigen::Index i, Eigen::Index j) const {
  if (i >= j) return ConstTile(element(3 * i, 3 * j), 3, 3);
  return ConstTile(element(3 * j, 3 * i), 3, 3).transpose();
}

Eigen::MatrixX3d PackedCovariance::column(Eigen::Index j) const {
  Eigen::MatrixX3d column(size_, 3);
  column.topRows(3 * j) = ConstTile(element(3 * j, 0), 3, 3 * j).transpose();
  for (Eigen::Index row = 3 * j; row < size_;) {
    const Eigen::Index rows = std::min((panel_of(row) + 1) * kPanelRows, size_) - row;
    column.middleRows(row, rows) = ConstTile(element(row, 3 * j), rows, 3);
    row += rows;
  }
  return column;
}

void PackedCovariance::suffix_products(std::span<const Eigen::Index> starts,
                                       const Eigen::Ref<const Eigen::MatrixX3d>& B,
                                       Eigen::Ref<Eigen::MatrixXd> product, int columns_of_B,
                                       PassOrder order) const {
  SuffixSums sums(starts, B, size_, 3 * starts.front(), scratch_);
  for (const std::size_t p : panels_from(3 * starts.front(), order)) {
    sums.add_panel(panels_[p], top_of(p), columns_of_B);
  }
  sums.write(product, columns_of_B);
}

void PackedCovariance::head_products(std::span<const Eigen::Index> starts,
                                     const Eigen::Ref<const Eigen::MatrixX3d>& B,
                                     Eigen::Ref<Eigen::MatrixXd> product) const {
  SuffixSums sums(starts, B, size_, 0, scratch_);
  for (const std::size_t p : panels_from(3 * starts.front(), PassOrder::forward)) {
    sums.add_head(panels_[p], top_of(p));
  }
  sums.write(product);
}

PackedCovariance::Sides PackedCovariance::side_products(
    const Eigen::Ref<const Eigen::MatrixX3d>& B) const {
  Sides sides{Eigen::MatrixX3d::Zero(size_, 3), Eigen::MatrixX3d::Zero(size_, 3)};
  if (size_ == 0) return sides;
  const Eigen::Index start = 0;
  SuffixSums sums(std::span(&start, 1), B, size_, 0, scratch_);
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const Eigen::Index top = top_of(p);
    const Eigen::Index rows = std::min(kPanelRows, size_ - top);
    sides.before.middleRows(top, rows) = sums.take_sides(panels_[p], top).topRows(rows);
    // The tile on the diagonal, block by block.
    for (Eigen::Index i = top; i < top + rows; i += 3) {
      const ConstTile row(element(i, top), 3, rows);
      sides.before.middleRows<3>(i) += row.leftCols(i - top) * B.middleRows(top, i - top);
      const Eigen::Index after = top + rows - (i + 3);
      sides.after.middleRows<3>(i) = row.rightCols(after) * B.middleRows(i + 3, after);
    }
  }
  Eigen::MatrixXd below_diagonal(size_, 3);
  Eigen::Ref<Eigen::MatrixXd> below(below_diagonal);
  sums.write(below);
  sides.after += below;
  return sides;
}

void PackedCovariance::downdate(const Eigen::Ref<const Eigen::MatrixXd>& V, Eigen::Index first_row,
                                PassOrder order) {
  for (const std::size_t p : panels_from(first_row, order)) downdate_rows(p, first_row, V);
}

// Panel after panel, so that a panel stays in the cache for all factors.
void PackedCovariance::downdate(std::span<const DowndateFactor> factors) {
  for (std::size_t p = panels_.size(); p-- > 0;) {
    for (const DowndateFactor& factor : factors) downdate_rows(p, factor.first_row, factor.V);
  }
}

// In the rows of a panel that are kept, the kept columns become zero again while they are in the
// cache; only the blocks on the diagonal have to be remembered.
void PackedCovariance::downdate_but(std::span<const Eigen::Index> kept,
                                    const Eigen::Ref<const Eigen::MatrixXd>& V) {
  using PanelColumn = Eigen::Map<Eigen::Array<double, kPanelRows, 1>>;
  for (std::size_t p = 0; p < panels_.size(); ++p) {
    const Eigen::Index first = top_of(p) / 3;
    const auto rows_begin = std::lower_bound(kept.begin(), kept.end(), first);
    const auto rows_end = std::lower_bound(rows_begin, kept.end(), first + kPanelRows / 3);
    std::vector<Eigen::Matrix3d> own;
    Eigen::Array<double, kPanelRows, 1> is_other = Eigen::Array<double, kPanelRows, 1>::Ones();
    for (auto k = rows_begin; k != rows_end; ++k) {
      own.push_back(block(*k, *k));
      is_other.segment<3>(3 * (*k - first)).setZero();
    }
    downdate_rows(p, 0, V);
    if (own.empty()) continue;
    for (auto k = kept.begin(); k != rows_end; ++k) {
      for (Eigen::Index column = 3 * *k; column < 3 * *k + 3; ++column) {
        PanelColumn(element(top_of(p), column)) *= is_other;
      }
    }
    for (auto k = rows_begin; k != rows_end; ++k) {
      Tile(element(3 * *k, 3 * *k), 3, 3) = own[static_cast<std::size_t>(k - rows_begin)];
    }
  }
}

void PackedCovariance::downdate_rows(std::size_t panel, Eigen::Index first_row,
                                     const Eigen::Ref<const Eigen::MatrixXd>& V) {
  const Eigen::Index top = top_of(panel);
  const Eigen::Index end_row = first_row + V.rows();
  const Eigen::Index begin = std::max(first_row, top);
  const Eigen::Index end = std::min(end_row, top + kPanelRows);
  if (begin >= end) return;
  double* const columns = panels_[panel] + kPanelRows * first_row;
  if (end - begin == kPanelRows) {
    downdate_panel(columns, end - first_row, V.data() + (top - first_row), V.outerStride(),
                   V.data(), V.outerStride(), V.cols());
    return;
  }
  // The kernel takes whole panels: zeros where V does not reach.
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(kPanelRows, V.cols());
  rows.middleRows(begin - top, end - begin) = V.middleRows(begin - first_row, end - begin);
  downdate_panel(columns, end - first_row, rows.data(), kPanelRows, V.data(), V.outerStride(),
                 V.cols());
}

Eigen::MatrixXd PackedCovariance::full() const {
  Eigen::MatrixXd P(size_, size_);
  for (Eigen::Index j = 0; 3 * j < size_; ++j) P.middleCols<3>(3 * j) = column(j);
  return P;
}

}  // namespace fathom::filter
