#pragma once

#include <Eigen/SparseCholesky>

namespace fathom {

using SparseFactor = Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower>;

/// The diagonal of A⁻¹ of a matrix that was factorised, in A's order: the elements of the inverse
/// on the pattern of the factor, from its last column to its first (Takahashi, Fagan and Chin
/// 1973). It costs about as much as the factorisation.
Eigen::VectorXd inverse_diagonal(const SparseFactor& factor);

}  // namespace fathom
