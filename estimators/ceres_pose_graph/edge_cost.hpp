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

/// The same of a registration that shares errors with its pictures: Lᵀ (e + Dᵀ (G_from n_from +
/// G_to n_to)), Ω its own information, D = diag(Rot(θ_z), 1). Parameters: those of EdgeCost, then
/// n_from and n_to in units of their standard deviations (docs/shared_errors.md).
class SharedEdgeCost final : public ceres::SizedCostFunction<3, 3, 3, 3, 3> {
 public:
  explicit SharedEdgeCost(const RelativePose& measurement);

  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  EdgeCost own_;
  Eigen::Matrix3d from_;  ///< Lᵀ Dᵀ G_from
  Eigen::Matrix3d to_;
};

/// n of a picture as its prior has it: the residual is n.
class ErrorsCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;
};

}  // namespace fathom
