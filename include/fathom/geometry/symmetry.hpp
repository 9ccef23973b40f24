#pragma once

#include <Eigen/Core>

namespace fathom {

/// What rounding may make of a symmetric matrix, as a share of its norm.
inline constexpr double kSymmetryRounding = 1e-9;

/// Whether a square matrix of finite numbers is symmetric but for such a share of its norm.
inline bool is_symmetric(const Eigen::Ref<const Eigen::MatrixXd>& matrix,
                         double share = kSymmetryRounding) {
  return (matrix - matrix.transpose()).norm() <= share * matrix.norm();
}

}  // namespace fathom
