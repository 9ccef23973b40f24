#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "src/datasets/simulated_log/simulated_log.hpp"

namespace fathom::test {

/// Three legs, some forty keyframes.
inline SimulatedLogOptions sweep() {
  SimulatedLogOptions options;
  options.mission.legs = 3;
  options.mission.leg_length_m = 4.0;
  options.mission.leg_spacing_m = 1.1;
  options.separation_frames = 3;
  return options;
}

inline FlownKeyframes flown(const SimulatedLogOptions& options) {
  return {fly_mission(options.mission, ""), static_cast<std::size_t>(options.separation_frames)};
}

inline std::vector<RelativePose> registrations_of(const MeasurementLog& log) {
  std::vector<RelativePose> all;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const auto& own = log.arrival(k).registrations;
    all.insert(all.end(), own.begin(), own.end());
  }
  return all;
}

/// What a measurement is off the truth by.
inline Eigen::Vector3d error_of(const RelativePose& z, const FlownKeyframes& keyframes) {
  const Pose truth = between(keyframes[z.from].pose, keyframes[z.to].pose);
  return {z.motion.x - truth.x, z.motion.y - truth.y, wrap_angle(z.motion.theta - truth.theta)};
}

}  // namespace fathom::test
