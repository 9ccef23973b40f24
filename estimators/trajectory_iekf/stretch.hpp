#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// The stretch of relative motions that the registrations ending at the newest keyframe n depend
/// on: those after keyframe `first`, the earliest `from` of them. Gives h and H of the paper's
/// section 3 (docs/estimators/trajectory_iekf.md).
class Stretch {
 public:
  /// `motions` are x_{first+1} … x_n.
  Stretch(std::size_t first, std::span<const Pose> motions);

  std::size_t first() const { return first_; }

  /// h = x_{from+1} ⊕ … ⊕ x_n: the pose of keyframe n in the frame of `from` ≥ first.
  Pose h(std::size_t from) const;

  /// H: the 3×3(n − first) Jacobian of h(from) with respect to the (x, y, θ) of each motion of the
  /// stretch; zero for motions up to `from`.
  Eigen::Matrix3Xd H(std::size_t from) const;

 private:
  std::size_t first_;
  std::vector<Pose> poses_;  ///< of keyframes first … n, in the frame of `first`
};

}  // namespace fathom
