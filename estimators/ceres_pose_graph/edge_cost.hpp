#pragma once

#include <Eigen/Core>
#include <ceres/sized_cost_function.h>

#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// The whitened residual Lᵀ e of one measurement with Ω = L Lᵀ, so that its squared norm is eᵀ Ω e.
/// Parameters: (x, y, θ) of `from` and of `to`, one 3-vector each; θ need not be wrapped. Analytic
/// Jacobians. docs/estimators/ceres_pose_graph.md.
class EdgeCost final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit EdgeCost(const RelativePose& measurement);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Pose motion_;
  Eigen::Matrix3d upper_;  ///< Lᵀ, or rows of a semi-definite Ω
};

}  // namespace fathom
