#include "estimators/trajectory_iekf/loop_factors.hpp"

#include <algorithm>
#include <utility>

#include "estimators/trajectory_iekf/factor_kernels.hpp"

namespace fathom {
namespace {

// Rows that all factors are taken through before the next: what they are multiplied with, or taken
// from, stays in the cache.
constexpr Eigen::Index kRows = 2048;

template <class Matrix>
ThreeColumns columns_at(const Matrix& matrix, Eigen::Index row, Eigen::Index column) {
  return {matrix.data() + row + column * matrix.outerStride(), matrix.outerStride()};
}

}  // namespace

void LoopFactors::add(filter::DowndateFactor factor) {
  size_ += static_cast<std::size_t>(factor.V.size());
  columns_ += factor.V.cols();
  factors_.push_back(std::move(factor));
}

void LoopFactors::clear() {
  factors_.clear();
  size_ = 0;
  columns_ = 0;
}

void LoopFactors::clear_rows(Eigen::Index row) {
  for (filter::DowndateFactor& factor : factors_) {
    const Eigen::Index own = row - factor.first_row;
    if (own >= 0 && own < factor.V.rows()) factor.V.middleRows<3>(own).setZero();
  }
}

Eigen::Index LoopFactors::first_correlated(Eigen::Index row) const {
  Eigen::Index first = row;
  for (const filter::DowndateFactor& factor : factors_) {
    if (factor.end_row() > row) first = std::min(first, factor.first_row);
  }
  return first;
}

Eigen::MatrixXd LoopFactors::transposed_suffix_products(std::span<const Eigen::Index> starts,
                                                        const Eigen::MatrixX3d& B) const {
  const Eigen::Index head = 3 * starts.front();
  const auto count = static_cast<Eigen::Index>(starts.size());
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(columns_, 3 * count);
  for (Eigen::Index s = 0; s < count; ++s) {
    const auto next = static_cast<std::size_t>(s + 1);
    const Eigen::Index end = next < starts.size() ? 3 * starts[next] : head + B.rows();
    for (Eigen::Index row = 3 * starts[static_cast<std::size_t>(s)]; row < end; row += kRows) {
      const Eigen::Index row_end = std::min(row + kRows, end);
      Eigen::Index at = 0;
      for (const filter::DowndateFactor& factor : factors_) {
        const Eigen::Index from = std::max(row, factor.first_row);
        const Eigen::Index rows = std::min(row_end, factor.end_row()) - from;
        for (Eigen::Index c = 0; c < factor.V.cols() && rows > 0; c += 3) {
          products.block<3, 3>(at + c, 3 * s) +=
              transposed_product(columns_at(factor.V, from - factor.first_row, c),
                                 columns_at(B, from - head, 0), rows);
        }
        at += factor.V.cols();
      }
    }
  }
  for (Eigen::Index s = count - 1; s-- > 0;) {
    products.middleCols<3>(3 * s) += products.middleCols<3>(3 * (s + 1));
  }
  return products;
}

void LoopFactors::subtract_products(const Eigen::MatrixXd& Y, Eigen::Index first_row,
                                    Eigen::Ref<Eigen::MatrixXd> product) const {
  const Eigen::Index end = first_row + product.rows();
  for (Eigen::Index row = first_row; row < end; row += kRows) {
    const Eigen::Index row_end = std::min(row + kRows, end);
    Eigen::Index at = 0;
    for (const filter::DowndateFactor& factor : factors_) {
      const Eigen::Index from = std::max(row, factor.first_row);
      const Eigen::Index rows = std::min(row_end, factor.end_row()) - from;
      for (Eigen::Index c = 0; c < factor.V.cols() && rows > 0; c += 3) {
        const ThreeColumns V = columns_at(factor.V, from - factor.first_row, c);
        for (Eigen::Index s = 0; s < product.cols(); s += 3) {
          subtract_product(V, Y.block<3, 3>(at + c, s), rows, &product(from - first_row, s),
                           product.outerStride());
        }
      }
      at += factor.V.cols();
    }
  }
}

}  // namespace fathom
