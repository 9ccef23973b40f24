#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::sparse {

/// The blocks of A⁻¹ on the pattern of the factor of A, the diagonal among them, without the rest
/// (Takahashi, Fagan and Chen 1973; Golub and Plemmons 1980): from the last supernode to the
/// first, with L = [L₁₁; L₂₁] of its panel and Y = L₂₁ L₁₁⁻¹,
///
///     Σ₂₁ = −Σ₂₂ Y        Σ₁₁ = L₁₁⁻ᵀ L₁₁⁻¹ − Yᵀ Σ₂₁
///
/// where all of Σ₂₂ that is needed lies in panels that are done.
class SelectedInverse {
 public:
  /// Of a factor of a positive definite matrix, which must outlive this.
  explicit SelectedInverse(const BlockCholesky<3>& factor);
  /// In the memory of the factor, which is none any more.
  static SelectedInverse in_place_of(BlockCholesky<3>& factor);

  /// The diagonal block of a node.
  Eigen::Matrix3d block(int node) const;
  /// The block in the rows of `a` and the columns of `b`, two nodes that are linked.
  Eigen::Matrix3d block(int a, int b) const;

 private:
  SelectedInverse(const BlockCholesky<3>& factor, double* panels);
  void run(double* panels) const;

  const BlockCholesky<3>* factor_;
  const Symbolic* symbolic_;
  std::vector<double> own_;  ///< where it is not in place
  const double* panels_;
};

}  // namespace fathom::sparse
