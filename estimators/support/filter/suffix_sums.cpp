#include "estimators/support/filter/suffix_sums.hpp"

#include <algorithm>

namespace fathom::filter {
namespace {

using PaddedRows = Eigen::Map<Eigen::Matrix<double, kPadded, Eigen::Dynamic>>;

}  // namespace

SuffixSums::SuffixSums(std::span<const Eigen::Index> starts,
                       const Eigen::Ref<const Eigen::MatrixX3d>& B, Eigen::Index size,
                       Eigen::Index first_row, Scratch& scratch)
    : first_row_(first_row), base_(first_row / kPanelRows * kPanelRows) {
  for (const Eigen::Index start : starts) cuts_.push_back(3 * start);
  cuts_.push_back(size);
  rows_ = (size + kPanelRows - 1) / kPanelRows * kPanelRows - base_;
  auto room = scratch.shaped(kPadded, rows_ * static_cast<Eigen::Index>(starts.size() + 1));
  room.setZero();
  B_ = room.data();
  PaddedRows(B_at(cuts_.front()), kPadded, B.rows()).topRows<3>() = B.transpose();
}

// B at the rows of a panel, those of other segments zero.
SuffixSums::PanelRows SuffixSums::rows_of_segment(Eigen::Index top, std::size_t segment) const {
  PanelRows rows = PanelRows::Zero();
  const Eigen::Index begin = std::max(top, cuts_[segment]);
  const Eigen::Index end = std::min(top + kPanelRows, cuts_[segment + 1]);
  if (begin < end) {
    rows.middleRows(begin - top, end - begin) =
        PaddedRows(B_at(begin), kPadded, end - begin).topRows<3>().transpose();
  }
  return rows;
}

void SuffixSums::add_rows(const PanelRows& sums, Eigen::Index top, std::size_t segment) {
  PaddedRows(sums_at(segment, top), kPadded, kPanelRows).topRows<3>() += sums.transpose();
}

// A panel's columns begin … end, left of its diagonal tile: B of the columns gives `row_sums`, B of
// the panel's rows the sums of the segments that these rows belong to, most often a single one.
void SuffixSums::add_columns(const double* panel, Eigen::Index top, std::size_t segment,
                             Eigen::Index begin, Eigen::Index end, int columns_of_B,
                             PanelRows& row_sums) {
  PanelRows once_only = PanelRows::Zero();
  bool is_first = true;
  for (std::size_t of_rows = segment; of_rows + 1 < cuts_.size(); ++of_rows) {
    if (cuts_[of_rows] >= top + kPanelRows || cuts_[of_rows + 1] <= top) continue;
    const PanelRows row_B = rows_of_segment(top, of_rows);
    sweep({panel + kPanelRows * begin, end - begin, row_B.data(), B_at(begin),
           (is_first ? row_sums : once_only).data(), sums_at(of_rows, begin)},
          columns_of_B);
    is_first = false;
  }
}

void SuffixSums::add_panel(const double* panel, Eigen::Index top, int columns_of_B) {
  const PanelRows no_B = PanelRows::Zero();
  Eigen::Matrix<double, kPadded, kPanelRows> nowhere;
  nowhere.setZero();
  for (std::size_t segment = 0; segment + 1 < cuts_.size(); ++segment) {
    PanelRows row_sums = PanelRows::Zero();
    const Eigen::Index left_end = std::min(cuts_[segment + 1], top);
    if (cuts_[segment] < left_end) {
      add_columns(panel, top, segment, cuts_[segment], left_end, columns_of_B, row_sums);
    }
    // The diagonal tile holds both triangles.
    const Eigen::Index begin = std::max(cuts_[segment], top);
    const Eigen::Index end = std::min(cuts_[segment + 1], top + kPanelRows);
    if (begin < end) {
      sweep({panel + kPanelRows * begin, end - begin, no_B.data(), B_at(begin), row_sums.data(),
             nowhere.data()},
            columns_of_B);
    }
    if (cuts_[segment] < end) add_rows(row_sums, top, segment);
  }
}

void SuffixSums::add_head(const double* panel, Eigen::Index top) {
  PanelRows nowhere = PanelRows::Zero();
  add_columns(panel, top, 0, 0, std::min(cuts_.front(), top), 3, nowhere);
  if (cuts_.front() <= top) return;
  // The stretch starts within this panel: the columns of its diagonal tile before it.
  for (std::size_t segment = 0; segment + 1 < cuts_.size(); ++segment) {
    const PanelRows row_B = rows_of_segment(top, segment);
    sweep({panel + kPanelRows * top, cuts_.front() - top, row_B.data(), B_at(top), nowhere.data(),
           sums_at(segment, top)},
          3);
  }
}

Eigen::MatrixX3d SuffixSums::take_sides(const double* panel, Eigen::Index top) {
  PanelRows row_sums = PanelRows::Zero();
  add_columns(panel, top, 0, 0, top, 3, row_sums);
  return row_sums;
}

void SuffixSums::write(Eigen::Ref<Eigen::MatrixXd>& product, int columns_of_B) const {
  const std::size_t segments = cuts_.size() - 1;
  for (Eigen::Index row = 0; row < product.rows(); ++row) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t s = segments; s-- > 0;) {
      sum += Eigen::Map<const Eigen::Vector3d>(sums_at(s, first_row_ + row));
      const auto column = static_cast<Eigen::Index>(3 * s);
      for (int q = 0; q < columns_of_B; ++q) product(row, column + q) = sum(q);
    }
  }
}

}  // namespace fathom::filter
