#include "estimators/trajectory_iekf/motion_covariance.hpp"

#include <algorithm>
#include <utility>

namespace fathom {
namespace {

std::size_t triangle(Eigen::Index rows) {
  return static_cast<std::size_t>(rows * (rows + 1) / 2);
}

// Starts that lie among the first so many motions.
std::span<const Eigen::Index> starts_before(std::span<const Eigen::Index> starts,
                                            Eigen::Index motions) {
  const auto end = std::lower_bound(starts.begin(), starts.end(), motions);
  return starts.first(static_cast<std::size_t>(end - starts.begin()));
}

// Every pass begins where the last has ended: there the triangle is still in the cache.
filter::PassOrder order_of(int pass) {
  return pass % 2 == 1 ? filter::PassOrder::forward : filter::PassOrder::backward;
}

}  // namespace

Eigen::Index MotionCovariance::size() const {
  return dense_.size() + 3 * static_cast<Eigen::Index>(later_.size());
}

void MotionCovariance::append(const Eigen::Matrix3d& Q) {
  later_.push_back(Q);
}

void MotionCovariance::replace(Eigen::Index i, const Eigen::Matrix3d& Q) {
  factors_.clear_rows(3 * i);
  if (i < dense_motions()) {
    dense_.replace(i, Q);
  } else {
    later_[static_cast<std::size_t>(i - dense_motions())] = Q;
  }
}

Eigen::MatrixX3d MotionCovariance::column(Eigen::Index i) const {
  Eigen::MatrixX3d column = Eigen::MatrixX3d::Zero(size(), 3);
  if (i < dense_motions()) {
    column.topRows(dense_.size()) = dense_.column(i);
  } else {
    column.middleRows<3>(3 * i) = later_[static_cast<std::size_t>(i - dense_motions())];
  }
  for (const filter::DowndateFactor& factor : factors_.factors()) {
    const Eigen::Index row = 3 * i - factor.first_row;
    if (row < 0 || row >= factor.V.rows()) continue;
    column.middleRows(factor.first_row, factor.V.rows()) -=
        factor.V * factor.V.middleRows<3>(row).transpose();
  }
  return column;
}

void MotionCovariance::suffix_products(std::span<const Eigen::Index> starts,
                                       const Eigen::MatrixX3d& B,
                                       Eigen::Ref<Eigen::MatrixXd> product, int pass) const {
  const int columns_of_B = pass == 1 ? 3 : 2;
  const Eigen::Index first = starts.front();
  const auto in_dense = starts_before(starts, dense_motions());
  const Eigen::Index dense_rows = std::max<Eigen::Index>(dense_.size() - 3 * first, 0);
  const auto dense_columns = static_cast<Eigen::Index>(3 * in_dense.size());
  if (!in_dense.empty()) {
    dense_.suffix_products(in_dense, B.topRows(dense_rows),
                           product.topLeftCorner(dense_rows, dense_columns), columns_of_B,
                           order_of(pass));
  }
  // Of these, too, the third columns stay: the factors' share is in them.
  for (Eigen::Index column = dense_columns; column < product.cols(); column += 3) {
    product.block(0, column, dense_rows, columns_of_B).setZero();
  }
  for (Eigen::Index row = dense_rows; row < product.rows(); row += 3) {
    const Eigen::Index i = first + row / 3;
    const Eigen::Matrix3d QB =
        later_[static_cast<std::size_t>(i - dense_motions())] * B.middleRows<3>(row);
    const auto reaching = static_cast<Eigen::Index>(starts_before(starts, i + 1).size());
    for (Eigen::Index s = 0; s < product.cols() / 3; ++s) {
      auto block = product.block(row, 3 * s, 3, columns_of_B);
      if (s < reaching) {
        block = QB.leftCols(columns_of_B);
      } else {
        block.setZero();
      }
    }
  }
  if (factors_.is_empty()) return;
  Eigen::MatrixXd Y = factors_.transposed_suffix_products(starts, B);
  for (Eigen::Index c = 2; columns_of_B == 2 && c < Y.cols(); c += 3) Y.col(c).setZero();
  factors_.subtract_products(Y, 3 * first, product);
}

Eigen::MatrixXd MotionCovariance::head_products(std::span<const Eigen::Index> starts,
                                                const Eigen::MatrixX3d& B) const {
  const Eigen::Index begin = first_correlated(starts.front());
  const Eigen::Index rows = 3 * (starts.front() - begin);
  const auto columns = static_cast<Eigen::Index>(3 * starts.size());
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(rows, columns);
  if (rows == 0) return product;
  const auto in_dense = starts_before(starts, dense_motions());
  if (!in_dense.empty()) {
    dense_.head_products(in_dense, B.topRows(dense_.size() - 3 * starts.front()),
                         product.leftCols(static_cast<Eigen::Index>(3 * in_dense.size())));
  }
  if (!factors_.is_empty()) {
    factors_.subtract_products(factors_.transposed_suffix_products(starts, B), 3 * begin, product);
  }
  return product;
}

Eigen::Index MotionCovariance::first_correlated(Eigen::Index start) const {
  if (start < dense_motions()) return 0;
  return factors_.first_correlated(3 * start) / 3;
}

void MotionCovariance::downdate(const Eigen::Ref<const Eigen::MatrixXd>& V, int passes) {
  const Eigen::Index first_row = size() - V.rows();
  if (is_cheaper_dense(factors_.size() + static_cast<std::size_t>(V.size()))) {
    fold();
    dense_.downdate(V, first_row, order_of(passes + 1));
  } else {
    factors_.add({first_row, V});
  }
}

// A linearisation goes over the factors twice, over C once. What folding would add to C is what the
// factors may cost.
bool MotionCovariance::is_cheaper_dense(std::size_t numbers_in_factors) const {
  if (form_ != Form::cheapest) return form_ == Form::dense;
  return 2 * numbers_in_factors > triangle(size()) - triangle(dense_.size());
}

void MotionCovariance::fold() {
  for (const Eigen::Matrix3d& Q : later_) dense_.append(Q);
  later_.clear();
  dense_.downdate(factors_.factors());
  factors_.clear();
}

// Motion after motion: of the pairs that k adds, those with others come from the triangle of C in
// one pass.
std::vector<Eigen::Matrix3d> MotionCovariance::congruences(const Eigen::MatrixX3d& B,
                                                           Over over) const {
  const Eigen::Index motions = size() / 3;
  const bool up = over == Over::motions_up_to;
  const auto sides = dense_.side_products(B.topRows(dense_.size()));
  const Eigen::MatrixX3d& others = up ? sides.before : sides.after;
  std::vector<Eigen::Matrix3d> sums(static_cast<std::size_t>(motions));
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (Eigen::Index step = 0; step < motions; ++step) {
    const Eigen::Index k = up ? step : motions - 1 - step;
    const Eigen::Matrix3d B_k = B.middleRows<3>(3 * k);
    if (k < dense_motions()) {
      const Eigen::Matrix3d cross = B_k.transpose() * others.middleRows<3>(3 * k);
      sum += B_k.transpose() * dense_.block(k, k) * B_k + cross + cross.transpose();
    } else {
      sum += B_k.transpose() * later_[static_cast<std::size_t>(k - dense_motions())] * B_k;
    }
    sums[static_cast<std::size_t>(k)] = sum;
  }
  subtract_congruences(B, over, sums);
  return sums;
}

// Σ TᵀT of the factors, with T = Σ V_iᵀ B_i over the motions so far: it grows within a factor's
// rows, and stays as it is for all motions after them.
void MotionCovariance::subtract_congruences(const Eigen::MatrixX3d& B, Over over,
                                            std::vector<Eigen::Matrix3d>& sums) const {
  const bool up = over == Over::motions_up_to;
  const auto motions = static_cast<Eigen::Index>(sums.size());
  const auto at = [&](Eigen::Index k) {
    return static_cast<std::size_t>(up ? k : motions - 1 - k);
  };
  std::vector<Eigen::Matrix3d> from_here(sums.size() + 1, Eigen::Matrix3d::Zero());
  for (const filter::DowndateFactor& factor : factors_.factors()) {
    const Eigen::Index first = factor.first_row / 3;
    const Eigen::Index length = factor.V.rows() / 3;
    for (Eigen::Index column = 0; column < factor.V.cols(); column += 3) {
      Eigen::Matrix3d T = Eigen::Matrix3d::Zero();
      for (Eigen::Index step = 0; step < length; ++step) {
        const Eigen::Index i = up ? step : length - 1 - step;
        T += factor.V.block<3, 3>(3 * i, column).transpose() * B.middleRows<3>(3 * (first + i));
        sums[static_cast<std::size_t>(first + i)] -= T.transpose() * T;
      }
      from_here[static_cast<std::size_t>(up ? first + length : motions - first)] +=
          T.transpose() * T;
    }
  }
  Eigen::Matrix3d rest = Eigen::Matrix3d::Zero();
  for (Eigen::Index step = 0; step < motions; ++step) {
    rest += from_here[static_cast<std::size_t>(step)];
    sums[at(step)] -= rest;
  }
}

Eigen::MatrixXd MotionCovariance::full() const {
  Eigen::MatrixXd P = Eigen::MatrixXd::Zero(size(), size());
  P.topLeftCorner(dense_.size(), dense_.size()) = dense_.full();
  for (std::size_t i = 0; i < later_.size(); ++i) {
    const Eigen::Index row = dense_.size() + static_cast<Eigen::Index>(3 * i);
    P.block<3, 3>(row, row) = later_[i];
  }
  for (const filter::DowndateFactor& factor : factors_.factors()) {
    P.block(factor.first_row, factor.first_row, factor.V.rows(), factor.V.rows()).noalias() -=
        factor.V * factor.V.transpose();
  }
  return P;
}

std::size_t MotionCovariance::bytes() const {
  return dense_.bytes() + later_.capacity() * sizeof(Eigen::Matrix3d) + factors_.bytes();
}

}  // namespace fathom
