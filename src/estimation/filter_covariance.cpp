#include "fathom/estimation/filter_covariance.hpp"

#include <algorithm>
#include <cblas.h>

namespace fathom {
namespace {

// C += op(A) B through BLAS, op(A) being rows×inner; B and C are parts, starting at b and c, of
// matrices with as many columns as there are in B.
void add_product(CBLAS_TRANSPOSE op, Eigen::Index rows, Eigen::Index inner, const double* a,
                 Eigen::Index a_stride, const double* b, const Eigen::MatrixXd& B, double* c,
                 const Eigen::MatrixXd& C) {
  if (rows == 0 || inner == 0 || B.cols() == 0) return;
  cblas_dgemm(CblasColMajor, op, CblasNoTrans, static_cast<int>(rows), static_cast<int>(B.cols()),
              static_cast<int>(inner), 1.0, a, static_cast<int>(a_stride), b,
              static_cast<int>(B.outerStride()), 1.0, c, static_cast<int>(C.outerStride()));
}

}  // namespace

void FilterCovariance::reserve(Eigen::Index rows) {
  if (rows <= storage_.rows()) return;
  // An eighth more: all copies together cost a few times the last, and memory stays near what the
  // state needs.
  const Eigen::Index capacity = std::max<Eigen::Index>(rows + rows / 8, 96);
  Eigen::MatrixXd larger(capacity, capacity);
  larger.topLeftCorner(size_, size_).triangularView<Eigen::Lower>() =
      storage_.topLeftCorner(size_, size_);
  storage_.swap(larger);
}

void FilterCovariance::append(const Eigen::Matrix3d& covariance) {
  append(Eigen::Matrix3Xd::Zero(3, size_), covariance);
}

void FilterCovariance::append(const Eigen::Matrix3Xd& cross, const Eigen::Matrix3d& covariance) {
  reserve(size_ + 3);
  storage_.block(size_, 0, 3, size_) = cross;
  storage_.block<3, 3>(size_, size_) = covariance;
  size_ += 3;
}

Eigen::Matrix3d FilterCovariance::block(Eigen::Index i, Eigen::Index j) const {
  if (i == j) return storage_.block<3, 3>(3 * i, 3 * i).selfadjointView<Eigen::Lower>();
  if (i > j) return storage_.block<3, 3>(3 * i, 3 * j);
  return storage_.block<3, 3>(3 * j, 3 * i).transpose();
}

Eigen::MatrixX3d FilterCovariance::column(Eigen::Index j) const {
  const Eigen::Index below = size_ - 3 * (j + 1);
  Eigen::MatrixX3d column(size_, 3);
  column.topRows(3 * j) = storage_.block(3 * j, 0, 3, 3 * j).transpose();
  column.middleRows<3>(3 * j) = block(j, j);
  column.bottomRows(below) = storage_.block(3 * (j + 1), 3 * j, below, 3);
  return column;
}

Eigen::MatrixXd FilterCovariance::tail_times(Eigen::Index first, const Eigen::MatrixXd& B) const {
  // Panels of columns, each used twice while in cache: once for the rows below the diagonal, once
  // transposed for those right of it. Reads the triangle once; BLAS' own symmetric product takes
  // three times as long for so narrow a B.
  constexpr Eigen::Index kPanel = 32;
  const Eigen::Index head = 3 * first;
  const Eigen::Index tail = size_ - head;
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(tail, B.cols());
  for (Eigen::Index j = 0; j < tail; j += kPanel) {
    const Eigen::Index width = std::min(kPanel, tail - j);
    const Eigen::Index below = tail - j - width;
    product.middleRows(j, width).noalias() +=
        storage_.block(head + j, head + j, width, width).selfadjointView<Eigen::Lower>() *
        B.middleRows(j, width);
    const double* panel = storage_.data() + head + j + width + (head + j) * storage_.outerStride();
    add_product(CblasTrans, width, below, panel, storage_.outerStride(), B.data() + j + width, B,
                product.data() + j, product);
    add_product(CblasNoTrans, below, width, panel, storage_.outerStride(), B.data() + j, B,
                product.data() + j + width, product);
  }
  return product;
}

Eigen::MatrixXd FilterCovariance::times(Eigen::Index first, const Eigen::MatrixXd& B) const {
  const Eigen::Index head = 3 * first;
  Eigen::MatrixXd product = Eigen::MatrixXd::Zero(size_, B.cols());
  product.bottomRows(size_ - head) = tail_times(first, B);
  add_product(CblasTrans, head, size_ - head, storage_.data() + head, storage_.outerStride(),
              B.data(), B, product.data(), product);
  return product;
}

void FilterCovariance::downdate(const Eigen::MatrixXd& W) {
  if (size_ == 0) return;
  cblas_dsyrk(CblasColMajor, CblasLower, CblasTrans, static_cast<int>(size_),
              static_cast<int>(W.rows()), -1.0, W.data(), static_cast<int>(W.outerStride()), 1.0,
              storage_.data(), static_cast<int>(storage_.outerStride()));
}

Eigen::MatrixXd FilterCovariance::full() const {
  return storage_.topLeftCorner(size_, size_).selfadjointView<Eigen::Lower>();
}

}  // namespace fathom
