#include "suffix_sums.hpp"

#include <algorithm>

namespace fathom {

SuffixSums::SuffixSums(std::span<const Eigen::Index> starts, const Eigen::MatrixX3d& B,
                       Eigen::Index size, Eigen::Index first_row)
    : base_(first_row / kPanelRows * kPanelRows), first_row_(first_row), size_(size) {
  for (const Eigen::Index start : starts) cuts_.push_back(3 * start);
  cuts_.push_back(size);
  const Eigen::Index end = (size + kPanelRows - 1) / kPanelRows * kPanelRows;
  B_ = Padded::Zero(kPadded, end - base_);
  B_.block(0, cuts_.front() - base_, 3, B.rows()) = B.transpose();
  sums_.assign(starts.size(), Padded::Zero(kPadded, end - base_));
}

// B at the rows of a panel, those of other segments zero.
SuffixSums::PanelRows SuffixSums::rows_of_segment(Eigen::Index top, std::size_t segment) const {
  PanelRows rows = PanelRows::Zero();
  const Eigen::Index begin = std::max(top, cuts_[segment]);
  const Eigen::Index end = std::min(top + kPanelRows, cuts_[segment + 1]);
  if (begin < end) {
    rows.middleRows(begin - top, end - begin) =
        B_.block(0, begin - base_, 3, end - begin).transpose();
  }
  return rows;
}

void SuffixSums::add_rows(const PanelRows& sums, Eigen::Index top, std::size_t segment) {
  sums_[segment].block<3, kPanelRows>(0, top - base_) += sums.transpose();
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
    sweep({panel + kPanelRows * begin, end - begin, row_B.data(),
           B_.data() + kPadded * (begin - base_), (is_first ? row_sums : once_only).data(),
           sums_[of_rows].data() + kPadded * (begin - base_)},
          columns_of_B);
    is_first = false;
  }
}

void SuffixSums::add_panel(const double* panel, Eigen::Index top, int columns_of_B) {
  const PanelRows no_B = PanelRows::Zero();
  Padded nowhere = Padded::Zero(kPadded, kPanelRows);
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
      sweep({panel + kPanelRows * begin, end - begin, no_B.data(),
             B_.data() + kPadded * (begin - base_), row_sums.data(), nowhere.data()},
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
  const Eigen::Index stretch = cuts_.front() - top;
  for (std::size_t segment = 0; segment + 1 < cuts_.size(); ++segment) {
    const PanelRows row_B = rows_of_segment(top, segment);
    sweep({panel + kPanelRows * top, stretch, row_B.data(), B_.data() + kPadded * top,
           nowhere.data(), sums_[segment].data() + kPadded * top},
          3);
  }
}

Eigen::MatrixX3d SuffixSums::take_sides(const double* panel, Eigen::Index top) {
  PanelRows row_sums = PanelRows::Zero();
  add_columns(panel, top, 0, 0, top, 3, row_sums);
  return row_sums;
}

Eigen::MatrixXd SuffixSums::result() const {
  const Eigen::Index rows = size_ - first_row_;
  Eigen::MatrixXd result(rows, static_cast<Eigen::Index>(3 * sums_.size()));
  for (std::size_t s = sums_.size(); s-- > 0;) {
    const auto column = static_cast<Eigen::Index>(3 * s);
    result.middleCols<3>(column) = sums_[s].block(0, first_row_ - base_, 3, rows).transpose();
    if (s + 1 < sums_.size()) result.middleCols<3>(column) += result.middleCols<3>(column + 3);
  }
  return result;
}

}  // namespace fathom
