#pragma once

#include <optional>

#include <Eigen/Core>

#include "fathom/measurements/absolute_pose.hpp"

namespace fathom {

/// What an absolute measurement says of a keyframe's position and of its heading, in the frame of
/// the measurement's pose: what a picture shows and a result stores.
struct MeasuredParts {
  std::optional<Eigen::Vector2d> position;  ///< m
  /// Of the position, m², given the heading where the two are measured together alone; zero without
  /// a position.
  Eigen::Matrix2d position_covariance = Eigen::Matrix2d::Zero();
  std::optional<double> heading_rad;
  double heading_sigma_rad = 0.0;  ///< zero without a heading
};

/// A position that is known along one line alone is none. A fix of a point beside the keyframe, of
/// rank 2, is a position: it informs on the heading only together with that.
MeasuredParts parts_of(const AbsolutePose& measurement);

/// The same measurement where the world lies at `motion` in another frame.
AbsolutePose moved(const AbsolutePose& measurement, const Pose& motion);

}  // namespace fathom
