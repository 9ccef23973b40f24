#include "inverse_diagonal.hpp"

#include <vector>

namespace fathom {
namespace {

// With A⁻¹ = Z and A = L D Lᵀ, Z = D⁻¹ L⁻¹ + (I − Lᵀ) Z. Below the diagonal of column j
//   Z_ij = −Σ_k Z_ik L_kj,   Z_jj = 1/D_j − Σ_k L_kj Z_kj,   k > j in the pattern of L's column j,
// and every Z_ik that is asked for lies in the pattern of L's column min(i, k).
class InverseOnPattern {
 public:
  using Index = Eigen::Index;

  explicit InverseOnPattern(const SparseFactor& factor)
      : L_(factor.matrixL().nestedExpression()),
        Z_(static_cast<std::size_t>(L_.nonZeros())),
        diagonal_(factor.vectorD().cwiseInverse()),
        in_column_(static_cast<std::size_t>(L_.cols()), -1) {
    for (Index j = L_.cols(); j-- > 0;) solve_column(j);
  }

  const Eigen::VectorXd& diagonal() const { return diagonal_; }

 private:
  Index begin(Index column) const { return L_.outerIndexPtr()[column]; }
  Index end(Index column) const { return L_.outerIndexPtr()[column + 1]; }
  Index row(Index element) const { return L_.innerIndexPtr()[element]; }

  void solve_column(Index j) {
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
  void subtract_column(Index e) {
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

  const Eigen::SparseMatrix<double>& L_;
  std::vector<double> Z_;  // below the diagonal, at the elements of L
  Eigen::VectorXd diagonal_;
  std::vector<Index> in_column_;  // by row, its element of the column in work
};

}  // namespace

Eigen::VectorXd inverse_diagonal(const SparseFactor& factor) {
  const Eigen::VectorXd permuted = InverseOnPattern(factor).diagonal();
  if (factor.permutationP().size() == 0) return permuted;
  return factor.permutationPinv() * permuted;
}

}  // namespace fathom
