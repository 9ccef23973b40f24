#include "sparse_inverse.hpp"

#include <algorithm>
#include <utility>

namespace fathom {

// With A⁻¹ = Z and A = L D Lᵀ, Z = D⁻¹ L⁻¹ + (I − Lᵀ) Z. Below the diagonal of column j
//   Z_ij = −Σ_k Z_ik L_kj,   Z_jj = 1/D_j − Σ_k L_kj Z_kj,   k > j in the pattern of L's column j,
// and every Z_ik that is asked for lies in the pattern of L's column min(i, k).
SparseInverse::SparseInverse(const SparseFactor& factor)
    : L_(factor.matrixL().nestedExpression()),
      factor_(factor),
      Z_(L_.nonZeros()),
      diagonal_(L_.cols()),
      L_j_(Eigen::VectorXd::Zero(L_.cols())),
      Z_j_(Eigen::VectorXd::Zero(L_.cols())) {}

void SparseInverse::compute() {
  diagonal_ = factor_.vectorD().cwiseInverse();
  for (Index j = L_.cols(); j-- > 0;) solve_column(j);
}

void SparseInverse::solve_column(Index j) {
  for (Index e = begin(j); e < end(j); ++e) {
    L_j_[row(e)] = L_.valuePtr()[e];
    Z_j_[row(e)] = 0.0;
  }
  for (Index e = begin(j); e < end(j); ++e) subtract_column(row(e));
  for (Index e = begin(j); e < end(j); ++e) {
    const Index i = row(e);
    Z_[e] = Z_j_[i];
    diagonal_[j] -= L_j_[i] * Z_j_[i];
    L_j_[i] = 0.0;
  }
}

// What column k of Z adds to column j: Z is symmetric. Rows that column j does not have get numbers
// that nobody reads, which costs less than to ask for each.
void SparseInverse::subtract_column(Index k) {
  const double L_kj = L_j_[k];
  double sum = diagonal_[k] * L_kj;
  for (Index f = begin(k); f < end(k); ++f) {
    const Index i = row(f);
    const double Z_ik = Z_[f];
    Z_j_[i] -= Z_ik * L_kj;
    sum += Z_ik * L_j_[i];
  }
  Z_j_[k] -= sum;
}

SparseInverse::Index SparseInverse::place(Index i, Index j) const {
  const auto& order = factor_.permutationP().indices();
  const Index a = order.size() == 0 ? i : order[i];
  const Index b = order.size() == 0 ? j : order[j];
  if (a == b) return a;
  const auto [column, below] = std::minmax({a, b});
  const auto* const rows = L_.innerIndexPtr();
  const auto* const found = std::lower_bound(rows + begin(column), rows + end(column), below);
  return diagonal_.size() + (found - rows);
}

}  // namespace fathom
