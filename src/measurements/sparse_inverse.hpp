#pragma once

#include <Eigen/SparseCholesky>

namespace fathom {

using SparseFactor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>;

/// The elements of A⁻¹ on the pattern of the factor of A, from its last column to its first
/// (Takahashi, Fagan and Chin 1973). It costs about as much as the factorisation. The factor must
/// outlive it, and keep its pattern.
class SparseInverse {
 public:
  using Index = Eigen::Index;

  explicit SparseInverse(const SparseFactor& factor);

  /// Of the factorisation as it is now.
  void compute();

  /// Where (i, j) is kept, in the order of A; it must be in the pattern of A, or on the diagonal.
  Index place(Index i, Index j) const;
  double at(Index place) const {
    return place < diagonal_.size() ? diagonal_[place] : Z_[place - diagonal_.size()];
  }
  double operator()(Index i, Index j) const { return at(place(i, j)); }

 private:
  Index begin(Index column) const { return L_.outerIndexPtr()[column]; }
  Index end(Index column) const { return L_.outerIndexPtr()[column + 1]; }
  Index row(Index element) const { return L_.innerIndexPtr()[element]; }

  void solve_column(Index j);
  void subtract_column(Index k);

  const Eigen::SparseMatrix<double>& L_;  // without its diagonal of ones
  const SparseFactor& factor_;
  Eigen::VectorXd Z_;  // below the diagonal, at the elements of L
  Eigen::VectorXd diagonal_;
  Eigen::VectorXd L_j_;  // of the column in work, by row; 0 where it has none
  Eigen::VectorXd Z_j_;
};

}  // namespace fathom
