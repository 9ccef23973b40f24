#pragma once

#include <Eigen/Core>

#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// A loop as a filter takes it: y = C ν with covariance R, in three rows. Of a loop with positive
/// definite information C is the identity and R the covariance of ν. Of a semi-definite one there
/// are as many rows as it has rank; the others are zero in C and one in R, so that they change
/// nothing of what a filter computes.
struct LoopRows {
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  int rank = 3;

  bool is_whole() const { return rank == 3; }
};

/// `forward`: from the earlier node.
LoopRows loop_rows(const RelativePose& forward);

/// The Lᵀ of Ω = L Lᵀ, three rows, zero beyond the rank: the whitened residual is Lᵀ e.
Eigen::Matrix3d whitening(const Eigen::Matrix3d& information);

}  // namespace fathom
