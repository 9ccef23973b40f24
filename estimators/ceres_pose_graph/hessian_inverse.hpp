#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace fathom {

/// Of the inverse of a Hessian JᵀJ with three rows a block: of the first blocks, so many as are
/// asked for, the 3×3 blocks (k, k), and those (k, last) with the last of them.
struct InverseBlocks {
  std::vector<Eigen::Matrix3d> own;
  std::vector<Eigen::Matrix3d> with_last;
};

/// By the recursion of Takahashi, Fagan and Chin (*Formation of a Sparse Bus Impedance Matrix*,
/// 1973), which finds the entries of the inverse within the pattern of the Cholesky factor at about
/// the cost of the factor, and one solve for the last block's columns. Every diagonal block must be
/// dense. Where the sums of JᵀJ do not carry all rows (keeps_digits) a dense QR of J is taken, up
/// to kMostDenseColumns. Nothing where neither determines all.
std::optional<InverseBlocks> inverse_blocks(const Eigen::SparseMatrix<double>& jacobian,
                                            std::size_t count);

/// Columns of a Jacobian, of which a dense QR takes seconds: 500 poses.
inline constexpr Eigen::Index kMostDenseColumns = 1500;

/// Whether the Cholesky factor of JᵀJ is there and no pivot of it but rounding (kLeastPivotShare).
bool keeps_digits(const Eigen::SparseMatrix<double>& jacobian);

/// Likewise of a dense QR of J.
bool is_determined(const Eigen::SparseMatrix<double>& jacobian);

/// ½ gᵀ H⁻¹ g with g = Jᵀ r: by how much a full step lowers the quadratic model of the cost ½ rᵀ r.
/// Nothing where H is not positive definite.
std::optional<double> decrease_of_step(const Eigen::SparseMatrix<double>& jacobian,
                                       const Eigen::VectorXd& residuals);
/// Likewise by a dense QR of J.
std::optional<double> decrease_by_rows(const Eigen::SparseMatrix<double>& jacobian,
                                       const Eigen::VectorXd& residuals);

/// Of the inverse the rows and columns of these blocks alone, 3m×3m in the order given: a solve for
/// the columns of each. As inverse_blocks else.
std::optional<Eigen::MatrixXd> inverse_between(const Eigen::SparseMatrix<double>& jacobian,
                                               std::span<const std::size_t> blocks);

}  // namespace fathom
