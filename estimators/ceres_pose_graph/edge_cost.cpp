#include "estimators/ceres_pose_graph/edge_cost.hpp"

#include <array>

#include "fathom/estimation/loop_rows.hpp"
#include "fathom/geometry/covariance.hpp"

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

SharedEdgeCost::SharedEdgeCost(const RelativePose& measurement)
    : own_(RelativePose::from_covariance(measurement.from, measurement.to, measurement.motion,
                                         measurement.shared->own)) {
  const Eigen::Matrix3d D = planar_rotation(measurement.motion.theta);
  const Eigen::Matrix3d information =
      symmetric_inverse(transport(D.transpose(), measurement.shared->own));
  const Eigen::Matrix3d rows = whitening(information) * D.transpose();
  from_ = rows * measurement.shared->from.scaled();
  to_ = rows * measurement.shared->to.scaled();
}

bool SharedEdgeCost::Evaluate(double const* const* parameters, double* residuals,
                              double** jacobians) const {
  own_.Evaluate(parameters, residuals, jacobians);
  Eigen::Map<Eigen::Vector3d> whitened(residuals);
  whitened += from_ * Eigen::Map<const Eigen::Vector3d>(parameters[2]) +
              to_ * Eigen::Map<const Eigen::Vector3d>(parameters[3]);
  if (jacobians == nullptr) return true;
  const std::array<const Eigen::Matrix3d*, 2> J{&from_, &to_};
  for (std::size_t b = 0; b < J.size(); ++b) {
    if (jacobians[b + 2] == nullptr) continue;
    Eigen::Map<RowMajorMatrix3d> whitened_J(jacobians[b + 2]);
    whitened_J = *J[b];
  }
  return true;
}

bool ErrorsCost::Evaluate(double const* const* parameters, double* residuals,
                          double** jacobians) const {
  Eigen::Map<Eigen::Vector3d> n(residuals);
  n = Eigen::Map<const Eigen::Vector3d>(parameters[0]);
  if (jacobians != nullptr && jacobians[0] != nullptr) {
    Eigen::Map<RowMajorMatrix3d>(jacobians[0]).setIdentity();
  }
  return true;
}

}  // namespace fathom
