#pragma once

#include "fathom/datasets/frame_source.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

/// Frames' motions composed. Two that are registrations of one picture share its errors: with the
/// later one the altitude and tilt of the picture between them nearly cancel
/// (docs/front_end.md#visual-odometry).
class MotionChain {
 public:
  /// The motion of `next` follows. It has one.
  void append(const FrameInfo& next);

  /// Since the start of the chain, in its axes.
  const UncertainPose& motion() const { return motion_; }

 private:
  UncertainPose motion_;
  /// ∂motion/∂n of the newest picture, n in units of its σ.
  Eigen::Matrix3d by_newest_ = Eigen::Matrix3d::Zero();
};

}  // namespace fathom
