#include <cmath>

#include "fathom/front_end/calibration.hpp"

namespace fathom {

SeenMotion seen_motion(const FrameSource& frames, std::size_t from, std::size_t to,
                       const UncertainPose& registered) {
  const CameraModel& camera = frames.camera().model();
  const UncertainPose mount{{camera.mount_x_m, camera.mount_y_m, camera.mount_yaw_rad}};
  const UncertainPose seen = compose(inverse(mount), compose(registered, mount));
  SeenMotion motion{from,
                    to,
                    frames.info(from).time_ns,
                    frames.info(to).time_ns,
                    seen.mean,
                    seen.covariance.topLeftCorner<2, 2>().trace(),
                    seen.covariance(2, 2)};
  UncertainPose reckoned;
  for (std::size_t i = from + 1; i <= to; ++i) {
    const std::optional<UncertainPose>& step = frames.info(i).motion;
    if (!step) return motion;
    reckoned = compose(reckoned, *step);
  }
  motion.reckoned_variance_m2 = reckoned.covariance.topLeftCorner<2, 2>().trace();
  motion.reckoned_variance_rad2 = reckoned.covariance(2, 2);
  return motion;
}

CalibrationInput calibration_input(const FrameSource& frames, const AbsoluteReadings& readings) {
  CalibrationInput input;
  input.odometry = frames.recorded_odometry();
  input.is_visual_odometry = frames.is_visual_odometry();
  input.camera = frames.camera().model();
  input.files = frames.set_up_files();
  input.readings = readings;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameInfo& info = frames.info(i);
    input.frame_times_ns.push_back(info.time_ns);
    input.altitudes_m.push_back(info.altitude_m);
    if (info.ground_truth) input.references.push_back({info.time_ns, *info.ground_truth});
  }
  return input;
}

bool Estimated::is_off(double expected, double sigmas, double least) const {
  const double off = std::abs(value - expected);
  return off > sigmas * sigma && off > least;
}

}  // namespace fathom
