#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "set_up_fit.hpp"
#include "student_t.hpp"

namespace fathom {

/// A motion beside what dead reckoning says of its time.
struct Beside {
  std::size_t index = 0;
  Pose seen;                                         ///< of the camera
  Pose reckoned;                                     ///< of the body
  Eigen::Vector3d change = Eigen::Vector3d::Zero();  ///< of `seen`, a second
  double noise =
      1.0;  ///< of dead reckoning: the root of the motion's time, of that of a median one
  double seen_variance = 0.0;  ///< SeenMotion::variance_m2
};

/// What a motion takes.
double seconds_of(const SeenMotion& motion);

/// How the camera's motion changes, a second: by the motions beside it. Those of dead reckoning
/// would do, but for their noise, which would pass for changes.
Eigen::Vector3d change_of(std::span<const SeenMotion> motions, std::size_t i);

/// The motion of a body's point: a lever arm l adds (I − R(θ)) l.
Eigen::Matrix2d arm_of(const Beside& one);

/// The camera's translation, scaled and turned by the mounting's yaw.
Eigen::Vector2d turned(const Beside& one, const SetUpParameters& p);

/// The derivative of reckoned less registered motion by the time offset: a clock that is put later
/// shows what the body did before.
Eigen::Vector3d shifted(const Beside& one, const SetUpParameters& p);

/// Reckoned less registered motion, over `noise`; m, m, rad.
Eigen::Vector3d residual_of(const Beside& one, const SetUpParameters& p);

/// Scales of Student's t, which residuals are taken to follow.
struct ResidualSpread {
  static constexpr StudentT kT{3.0};
  double sigma_m = 0.0;
  double sigma_rad = 0.0;

  double squared(const Eigen::Vector3d& e) const;
  double weight(const Eigen::Vector3d& e) const { return kT.weight(squared(e)); }
  double curvature(const Eigen::Vector3d& e) const { return kT.curvature(squared(e)); }
  /// Of residuals, up to a constant.
  double log_density(const std::vector<Beside>& beside, const SetUpParameters& p) const;
};

/// Most likely ones, at least 1e-5 m and 1e-6 rad: dead reckoning without noise has none.
ResidualSpread spread_of(const std::vector<Beside>& beside, const SetUpParameters& p);

}  // namespace fathom
