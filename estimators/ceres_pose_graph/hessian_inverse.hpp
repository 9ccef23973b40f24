#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace fathom {

/// Of the inverse of a Hessian with three rows a block: of the first blocks, so many as are asked
/// for, the 3×3 blocks (k, k), and those (k, last) with the last of them.
struct InverseBlocks {
  std::vector<Eigen::Matrix3d> own;
  std::vector<Eigen::Matrix3d> with_last;
};

/// By the recursion of Takahashi, Fagan and Chin (*Formation of a Sparse Bus Impedance Matrix*,
/// 1973), which finds the entries of the inverse within the pattern of the Cholesky factor at about
/// the cost of the factor, and one solve for the last block's columns. Both triangles must be
/// there, and every diagonal block be dense. Nothing where the matrix is not positive definite.
std::optional<InverseBlocks> inverse_blocks(const Eigen::SparseMatrix<double>& hessian,
                                            std::size_t count);

/// Whether the Cholesky factor of a Hessian is there and no pivot of it but rounding
/// (kLeastPivotShare).
bool is_determined(const Eigen::SparseMatrix<double>& hessian);

/// ½ gᵀ H⁻¹ g: by how much a full step lowers the quadratic model of the cost. Nothing where H is
/// not positive definite.
std::optional<double> decrease_of_step(const Eigen::SparseMatrix<double>& hessian,
                                       const Eigen::VectorXd& gradient);

/// Of the inverse the rows and columns of these blocks alone, 3m×3m in the order given: a solve for
/// the columns of each. As inverse_blocks else.
std::optional<Eigen::MatrixXd> inverse_between(const Eigen::SparseMatrix<double>& hessian,
                                               std::span<const std::size_t> blocks);

}  // namespace fathom
