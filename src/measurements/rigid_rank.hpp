#pragma once

#include <span>

#include <Eigen/Core>

#include "fathom/measurements/absolute_pose.hpp"

namespace fathom {

/// An absolute measurement and the place of its keyframe in a set of poses that moves as one.
struct HeldPose {
  HeldPose(const AbsolutePose& measurement, const Pose& in_set);

  Eigen::Vector2d at;
  Eigen::Matrix3d information;  ///< world axes
};

/// How many of the three motions of a rigid set its absolute measurements determine.
int rank_of_motions(std::span<const HeldPose> held);

}  // namespace fathom
