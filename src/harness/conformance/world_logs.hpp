#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "logs.hpp"

/// Logs with absolute measurements, made from others.
namespace fathom::conformance {

struct WorldOptions {
  double heading_sigma_rad = 0.02;
  double position_sigma_m = 0.3;
  std::size_t heading_every = 1;   ///< keyframes; 0: none
  std::size_t position_every = 7;  ///< likewise
  std::size_t pose_every = 0;      ///< all three, with a full covariance
  double noise = 1.0;              ///< times the sigmas
  StartPose start{};
  std::uint64_t seed = 5;
};

Eigen::Matrix2d fix_covariance(double sigma_m);

/// A log with what a compass and a positioning system say of these poses.
MeasurementLog in_world(const MeasurementLog& plain, std::span<const Pose> truth,
                        const WorldOptions& options);

/// The circle with all of that.
MeasurementLog circle_in_world(const WorldOptions& options, LogOptions plain = {});

StartPose uncertain_start(const Pose& pose, double sigma_m, double sigma_rad);

}  // namespace fathom::conformance
