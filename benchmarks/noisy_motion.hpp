#pragma once

#include <cstddef>

#include <Eigen/Core>

#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom::benchmarks {

/// The motion from the true pose of keyframe `from` to that of `to`, measured with noise.
inline RelativePose noisy_motion(std::size_t from, const Pose& true_from, std::size_t to,
                                 const Pose& true_to, double sigma_m, double sigma_rad,
                                 RandomStream& noise) {
  Pose motion = between(true_from, true_to);
  motion.x += sigma_m * noise.normal();
  motion.y += sigma_m * noise.normal();
  motion.theta = wrap_angle(motion.theta + sigma_rad * noise.normal());
  const Eigen::Vector3d variances{sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad};
  return RelativePose::from_covariance(from, to, motion, variances.asDiagonal());
}

}  // namespace fathom::benchmarks
