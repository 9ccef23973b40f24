#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bag_messages.hpp"
#include "fathom/datasets/import.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

struct OdometryReading {
  std::int64_t time_ns = 0;
  PoseMessage message;
};

/// A row of odometry0.
struct OdometryRow {
  std::int64_t time_ns = 0;
  Pose pose;
  Eigen::Matrix3d step_covariance = Eigen::Matrix3d::Zero();  ///< zero at the first
};

struct OdometryRows {
  std::vector<OdometryRow> rows;
  std::string covariance_from;  ///< in words
  /// Rows at which it starts again.
  std::vector<std::size_t> restarts;
};

/// x, y and the yaw of a pose. Throws InputError where the quaternion is none.
Pose planar_pose(const PoseMessage& message);

/// Rows with the covariance of each step (docs/import.md): of a random walk where the options say
/// one; else the growth of the pose's covariance, C = J_Y⁻¹ (P_k − J_X P_{k−1} J_Xᵀ) J_Y⁻ᵀ for
/// X_k = X_{k−1} ⊕ Y, where that is positive definite at every step; else that of the velocity
/// times dt², where that is; else the random walk of the defaults. Of a step at which the odometry
/// starts again the bag says nothing: its σ is the length of the jump, of the heading
/// `restart_sigma_rad`.
OdometryRows odometry_rows(const std::vector<OdometryReading>& readings,
                           const BagImportOptions& options);

}  // namespace fathom
