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
  for (Index e = begin(j); e < end(j); ++e) subtract_column(e);
  for (Index e = begin(j); e < end(j); ++e) {
    diagonal_[j] -= L_.valuePtr()[e] * Z_[static_cast<std::size_t>(e)];
    in_column_[static_cast<std::size_t>(row(e))] = -1;
  }
}

// What column k of Z, the row of element e of column j, adds to column j: Z is symmetric.
void SparseInverse::subtract_column(Index e) {
  const Index k = row(e);
  const double L_kj = L_.valuePtr()[e];
  double sum = diagonal_[k] * L_kj;
  for (Index f = begin(k); f < end(k); ++f) {
    const Index at = in_column_[static_cast<std::size_t>(row(f))];
    if (at < 0) continue;
    const double Z_ik = Z_[static_cast<std::size_t>(f)];
    Z_[static_cast<std::size_t>(at)] -= Z_ik * L_kj;
    sum += Z_ik * L_.valuePtr()[at];
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
