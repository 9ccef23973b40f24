#include "estimators/ceres_pose_graph/edge_cost.hpp"

#include <array>

#include "fathom/estimation/loop_rows.hpp"

namespace fathom {
namespace {

using RowMajorMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

Pose pose_at(const double* parameters) {
  return {parameters[0], parameters[1], parameters[2]};
}

}  // namespace

EdgeCost::EdgeCost(const RelativePose& measurement)
    : motion_(measurement.motion), upper_(whitening(measurement.information)) {}

bool EdgeCost::Evaluate(double const* const* parameters, double* residuals,
                        double** jacobians) const {
  Eigen::Matrix3d J_from;
  Eigen::Matrix3d J_to;
  const Eigen::Vector3d e =
      residual(motion_, pose_at(parameters[0]), pose_at(parameters[1]), &J_from, &J_to);
  Eigen::Map<Eigen::Vector3d> whitened(residuals);
  whitened = upper_ * e;
  if (jacobians == nullptr) return true;
  const std::array<const Eigen::Matrix3d*, 2> J{&J_from, &J_to};
  for (std::size_t b = 0; b < J.size(); ++b) {
    if (jacobians[b] == nullptr) continue;
    Eigen::Map<RowMajorMatrix3d> whitened_J(jacobians[b]);
    whitened_J = upper_ * *J[b];
  }
  return true;
}

}  // namespace fathom
