#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bag_messages.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// Roll and pitch of one Imu message.
struct AttitudeReading {
  std::int64_t time_ns = 0;
  Tilt tilt;
  double variance = 0.0;  ///< of either, rad²; 0: not stated
};

/// Roll and pitch of an orientation Rot_z(yaw) Rot_y(pitch) Rot_x(roll), which ROS's axes of the
/// body (x forward, y to port, z up) make Fathom's. The quaternion need not have length one.
AttitudeReading attitude_of(std::int64_t time_ns, const ImuMessage& imu);

/// The rows of `attitude0`, or why there are none.
struct AttitudeRows {
  std::string rows;
  std::string fact;          ///< what they are, in degrees
  std::size_t unstated = 0;  ///< readings that the bag has no variance of
  std::string why_not;       ///< empty: there are rows
};

/// `readings`: not empty. `sigma_rad`: of readings without variance, or of `all`. No rows where a
/// reading is beyond what an image folder takes: the axes are not the body's then.
AttitudeRows attitude_rows(const std::vector<AttitudeReading>& readings, double sigma_rad,
                           bool all);

}  // namespace fathom
