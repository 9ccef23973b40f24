#pragma once

#include "src/datasets/simulated/simulated_survey.hpp"

namespace fathom::test {

/// A survey that takes next to no time: a tiny camera over a coarse floor.
inline SimulatedSurveyOptions small_survey() {
  SimulatedSurveyOptions options;
  options.world.metres_per_pixel = 0.03;
  options.mission.legs = 2;
  options.mission.leg_length_m = 3.0;
  options.camera.base.width = 64;
  options.camera.base.height = 48;
  options.camera.base.fx = 50.0;
  options.camera.base.fy = 52.0;
  return options;
}

/// The same with all that a camera and a noise can have.
inline SimulatedSurveyOptions full_survey() {
  SimulatedSurveyOptions options = small_survey();
  options.camera.cx = 30.25;
  options.camera.cy = 24.125;
  options.camera.distortion = {-0.11, 0.02, 0.0013, -0.0007, 0.003};
  options.camera.base.mount_x_m = 0.31;
  options.camera.base.mount_y_m = -0.12;
  options.camera.base.mount_yaw_rad = 0.4;
  options.altitude.amplitude_m = 0.3;
  options.odometry.covariance = {1e-4, 3e-5, -1e-5, 2e-4, 2e-5, 5e-5};
  return options;
}

}  // namespace fathom::test
