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
      Z_(static_cast<std::size_t>(L_.nonZeros())),
      diagonal_(factor.vectorD().cwiseInverse()),
      in_column_(static_cast<std::size_t>(L_.cols()), -1) {
  for (Index j = L_.cols(); j-- > 0;) solve_column(j);
}

void SparseInverse::solve_column(Index j) {
  for (Index e = begin(j); e < end(j); ++e) {
    in_column_[static_cast<std::size_t>(row(e))] = e;
    Z_[static_cast<std::size_t>(e)] = 0.0;
  }
  for (Index e = begin(j); e < end(j); ++e) subtract_column(j, e);
  for (Index e = begin(j); e < end(j); ++e) {
    diagonal_[j] -= L_.valuePtr()[e] * Z_[static_cast<std::size_t>(e)];
    in_column_[static_cast<std::size_t>(row(e))] = -1;
  }
}

// What column k of Z, the row of element e of column j, adds to column j: Z is symmetric.
void SparseInverse::subtract_column(Index j, Index e) {
  const Index k = row(e);
  const double* const L = L_.valuePtr();
  const double L_kj = L[e];
  double sum = diagonal_[k] * L_kj;
  // Rows of column j beyond k are rows of column k. Where there are as many, they are the same.
  const Index count = end(k) - begin(k);
  if (count == end(j) - e - 1) {
    const double* const Z_k = Z_.data() + begin(k);
    double* const Z_j = Z_.data() + e + 1;
    for (Index i = 0; i < count; ++i) Z_j[i] -= Z_k[i] * L_kj;
    for (Index i = 0; i < count; ++i) sum += Z_k[i] * L[e + 1 + i];
    Z_[static_cast<std::size_t>(e)] -= sum;
    return;
  }
  for (Index f = begin(k); f < end(k); ++f) {
    const Index at = in_column_[static_cast<std::size_t>(row(f))];
    if (at < 0) continue;
    const double Z_ik = Z_[static_cast<std::size_t>(f)];
    Z_[static_cast<std::size_t>(at)] -= Z_ik * L_kj;
    sum += Z_ik * L[at];
  }
  Z_[static_cast<std::size_t>(e)] -= sum;
}

double SparseInverse::operator()(Index i, Index j) const {
  const auto& order = factor_.permutationP().indices();
  const Index a = order.size() == 0 ? i : order[i];
  const Index b = order.size() == 0 ? j : order[j];
  if (a == b) return diagonal_[a];
  const auto [column, below] = std::minmax({a, b});
  const auto* const rows = L_.innerIndexPtr();
  const auto* const found = std::lower_bound(rows + begin(column), rows + end(column), below);
  return Z_[static_cast<std::size_t>(found - rows)];
}

}  // namespace fathom
