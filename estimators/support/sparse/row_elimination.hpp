#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::sparse {

/// Three rows of a least-squares problem J x = b.
struct LeastSquaresRows {
  struct Block {
    int position = 0;  ///< in the order of elimination
    Eigen::Matrix3d J = Eigen::Matrix3d::Zero();
  };
  std::vector<Block> blocks;
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
};

/// L of Jᵀ J = L Lᵀ into the factor, and Qᵀ b (3 numbers a position) into `y`, so that Lᵀ x = y is
/// the solution: multifrontal QR with Householder reflections (Davis, *Algorithm 915*, ACM TOMS 38,
/// 2011), without Jᵀ J. What a row says is lost beside one that is 10¹⁶ times as heavy, where in
/// Jᵀ J it is lost beside one that is 10⁸ times as heavy.
///
/// False where a pivot is less than `least_share` of the norm of its column of J, and so nothing
/// but rounding.
bool eliminate_rows(std::span<const LeastSquaresRows> rows, double least_share,
                    BlockCholesky<3>& factor, double* y);

}  // namespace fathom::sparse
