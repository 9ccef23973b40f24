#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "fathom/datasets/odometry_rows.hpp"

namespace fathom {

/// The `sensor.yaml` of a sensor that is no camera, as far as it is read.
struct SensorYaml {
  double mount_x_m = 0.0;
  double mount_y_m = 0.0;
  double mount_yaw_rad = 0.0;
  bool is_from_north = false;   ///< convention: clockwise_from_north
  double sigma_absolute = 0.0;  ///< standard deviation of a reading, in its unit; 0: not stated
  double sigma_relative = 0.0;  ///< likewise, as a share of the reading; the two are independent
  double scale = 1.0;           ///< of readings to metres
  std::int64_t time_offset_ns = 0;  ///< to be added to its time stamps
  OdometryFormat odometry = {};     ///< of odometry0, `scale` included
  bool keeps_outliers = false;      ///< outliers: keep
};

/// Keys `mounting` {x, y, yaw}, `convention` (of odometry0 as OdometryConvention, else
/// counter_clockwise_from_x or clockwise_from_north), `heading_unit`, `sigma_absolute`,
/// `sigma_relative`, `scale`, `time_offset_s` and `outliers` (keep or
/// leave_out), all optional, as the file is. Throws InputError
/// with file and line.
SensorYaml read_sensor_yaml(const std::filesystem::path& path);

/// Of the sensors in `mav0`: keys of their `sensor.yaml` that nobody reads, one line each with
/// file, line and what is read of this sensor. EuRoC's own are not among them, but for a camera's
/// T_BS that is not the identity, where there is no `mounting`.
std::vector<std::string> unread_sensor_keys(const std::filesystem::path& mav0);

}  // namespace fathom
