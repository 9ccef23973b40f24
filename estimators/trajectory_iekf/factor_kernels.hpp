#pragma once

#include <Eigen/Core>

namespace fathom {

/// Three columns side by side in a column-major matrix.
struct ThreeColumns {
  const double* data = nullptr;
  Eigen::Index stride = 0;
};

/// Vᵀ B over so many rows, 3×3.
Eigen::Matrix3d transposed_product(const ThreeColumns& V, const ThreeColumns& B, Eigen::Index rows);

/// product −= V Y over so many rows of three columns.
void subtract_product(const ThreeColumns& V, const Eigen::Matrix3d& Y, Eigen::Index rows,
                      double* product, Eigen::Index stride);

}  // namespace fathom
