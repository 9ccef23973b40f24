#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "fathom/core/random.hpp"
#include "fathom/front_end/calibration.hpp"

namespace fathom::test {

/// A vehicle that meanders at a speed that changes, and what its sensors say of it: a picture every
/// half second, odometry four times a second, both with noise.
struct TurningSurvey {
  double picture_interval_s = 0.5;
  std::size_t pictures = 150;
  double odometry_interval_s = 0.25;
  double noise_m = 0.005;  ///< of dead reckoning, a second
  double noise_rad = 0.003;
  double registration_noise_m = 0.001;
  double speed_change = 0.4;  ///< share of the speed
  double turning_rad = 1.2;   ///< amplitude of the heading
  Pose mount;                 ///< of the camera in the body
  double scale = 1.0;         ///< of registered motions
  double clock_late_s = 0.0;  ///< of odometry
  /// Headings are the same as long before as after: a way like that of a mower of an odd number of
  /// legs, which is the same from its end with a camera that is turned by π.
  std::optional<double> even_about_s;

  // The heading and speed are sums of sines, so the way is smooth; integrated finely.
  Pose truth(double t_s) const {
    constexpr double kStep_s = 0.01;
    Pose pose{0.0, 0.0, heading(0.0)};
    for (double t = 0.0; t < t_s - 1e-9; t += kStep_s) {
      const double h = heading(t + 0.5 * kStep_s);
      const double step_m = kStep_s * (0.5 + 0.5 * speed_change * std::sin(0.9 * t));
      pose = {pose.x + step_m * std::cos(h), pose.y + step_m * std::sin(h), 0.0};
    }
    pose.theta = wrap_angle(heading(t_s));
    return pose;
  }
  double heading(double t_s) const {
    const double t = even_about_s ? std::abs(t_s - *even_about_s) : t_s;
    return turning_rad * (std::sin(0.35 * t) + 0.3 * std::sin(0.83 * t + 1.0));
  }

  CalibrationInput input(std::uint64_t seed) const {
    CalibrationInput input;
    input.files.are_sensor_yaml = true;
    RandomStream stream(seed, "turning_survey");
    const double last_s = picture_interval_s * static_cast<double>(pictures - 1);
    // Beyond the pictures on both sides, for the clock.
    constexpr double kBeyond_s = 6.0;
    Pose reckoned;
    Pose before = truth(0.0);
    double unwrapped_rad = 0.0;
    std::vector<Pose> ahead{{}};
    for (double t = -kBeyond_s; t <= last_s + kBeyond_s + 1e-9; t += odometry_interval_s) {
      const Pose now = truth(std::max(0.0, t));
      Pose step = between(before, now);
      const double root = std::sqrt(odometry_interval_s);
      step.x += noise_m * root * stream.normal();
      step.y += noise_m * root * stream.normal();
      step.theta += noise_rad * root * stream.normal();
      reckoned = compose(reckoned, step);
      unwrapped_rad += step.theta;
      before = now;
      input.odometry.rows.push_back(
          {nanoseconds(t + clock_late_s), reckoned.x, reckoned.y, unwrapped_rad, false});
    }
    std::vector<Pose> cameras;
    for (std::size_t i = 0; i < pictures; ++i) {
      const double t = picture_interval_s * static_cast<double>(i);
      input.frame_times_ns.push_back(nanoseconds(t));
      input.altitudes_m.push_back(2.0);
      cameras.push_back(compose(truth(t), mount));
    }
    for (std::size_t i = 1; i < pictures; ++i) {
      Pose seen = between(cameras[i - 1], cameras[i]);
      seen.x = scale * seen.x + registration_noise_m * stream.normal();
      seen.y = scale * seen.y + registration_noise_m * stream.normal();
      input.motions.push_back({i - 1, i, input.frame_times_ns[i - 1], input.frame_times_ns[i], seen,
                               2.0 * registration_noise_m * registration_noise_m, 1e-8,
                               2.0 * noise_m * noise_m * picture_interval_s,
                               noise_rad * noise_rad * picture_interval_s});
    }
    return input;
  }

  static std::int64_t nanoseconds(double seconds) {
    return static_cast<std::int64_t>(std::llround(1e9 * seconds));
  }
};

/// As a camera sees it whose pictures are mirrored.
inline void mirror_pictures(CalibrationInput& input) {
  for (SeenMotion& motion : input.motions) {
    motion.camera = {motion.camera.x, -motion.camera.y, -motion.camera.theta};
  }
}

}  // namespace fathom::test
