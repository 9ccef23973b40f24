#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "estimators/support/sparse/block_cholesky.hpp"
#include "estimators/support/sparse/selected_inverse.hpp"

namespace fathom {

/// H = S Bᵀ W B S + P, with diagonal S and W, by the triples of its unknowns: its factor, and what
/// is asked of its inverse. One symbolic analysis serves all S and W.
class NormalFactor {
 public:
  using Index = Eigen::Index;

  /// The rows of B that have own errors (1, else 0) are those that W weights.
  NormalFactor(const Eigen::SparseMatrix<double>& B, const Eigen::VectorXd& is_own_row);
  NormalFactor(const NormalFactor&) = delete;  // the factor knows where its pattern is
  NormalFactor& operator=(const NormalFactor&) = delete;

  /// W is `own_weight` on those rows, 1 on the others; P is 1 from the row `first_prior` on, 0
  /// before. False where H is not positive definite, or a pivot holds rounding alone.
  bool factorise(const Eigen::VectorXd& scale, double own_weight, Index first_prior);

  double log_determinant() const;
  /// H⁻¹ b, of each column of b.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b);

  /// The block of H⁻¹ of triples a and b, which are the same or have a row of B in common.
  Eigen::Matrix3d inverse(Index a, Index b);
  /// An element of its diagonal.
  double variance(Index row) { return inverse(row / 3, row / 3)(row % 3, row % 3); }
  /// Σ b H⁻¹ bᵀ over the rows b of B S that have own errors.
  double own_trace();

 private:
  // A block of Bᵀ W B = rest + w own, in the rows of the triple that is eliminated later.
  struct Block {
    int row = 0;
    int column = 0;
    sparse::BlockPlace place = {};
    Eigen::Matrix3d rest = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d own = Eigen::Matrix3d::Zero();
  };

  static std::vector<Block> blocks_of(const Eigen::SparseMatrix<double>& rest,
                                      const Eigen::SparseMatrix<double>& own);
  static sparse::Symbolic pattern_of(int triples, const std::vector<Block>& blocks);

  std::vector<Block> blocks_;
  sparse::Symbolic symbolic_;
  sparse::BlockCholesky<3> factor_;
  std::optional<sparse::SelectedInverse> inverse_;  // where it was asked for
  Eigen::VectorXd scale_;
};

}  // namespace fathom
