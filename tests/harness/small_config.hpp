#pragma once

namespace fathom::test {

/// A survey that takes well under a second: one loop over a coarse floor, 33 small pictures with
/// all that a camera can have, keyframes every third, plenty of loops.
inline constexpr const char* kSmallSurvey = R"(dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: single_loop, loop_length_m: 2.4, loop_width_m: 1.6, loop_overrun_m: 0.8,
            turn_radius_m: 0.4}
  altitude: {base_m: 2, amplitude_m: 0.1, period_s: 11}
  camera: {width: 160, height: 120, fx: 130, fy: 131, distortion: [-0.05, 0.01, 0.001, -0.001, 0],
           mount_x_m: 0.2, mount_yaw_rad: 0.1}
  odometry: {sigma_x_m: 0.01, sigma_y_m: 0.01, sigma_theta_rad: 0.01}
front_end:
  keyframes: {separation_frames: 3}
  candidates: {max_distance_m: 1.6}
  ransac: {max_error_m: 0.05}
)";

/// What makes visual odometry of it, with noise added; to follow kSmallSurvey.
inline constexpr const char* kVisualOdometry = R"(
dataset.odometry.source: visual_odometry
dataset.odometry.covariance: [1.0e-4, 1.0e-5, 0, 1.0e-4, 0, 1.0e-4]
)";

/// Nothing is left to be estimated; to follow kSmallSurvey.
inline constexpr const char* kStatedSigmas = R"(
front_end.covariance: {altitude_sigma_m: 0, tilt_sigma_rad: 0.005, own_factor: 1}
)";

/// Likewise, and pictures have no errors in common.
inline constexpr const char* kNothingShared = R"(
front_end.covariance: {altitude_sigma_m: 0, tilt_sigma_rad: 0, own_factor: 1}
)";

}  // namespace fathom::test
