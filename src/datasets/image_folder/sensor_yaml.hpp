#pragma once

#include <filesystem>
#include <string>

namespace fathom {

/// The `sensor.yaml` of a compass or a positioning system, as far as it is read.
struct SensorYaml {
  double mount_x_m = 0.0;
  double mount_y_m = 0.0;
  double mount_yaw_rad = 0.0;
  bool is_from_north = false;  ///< convention: clockwise_from_north
};

/// Keys `mounting` {x, y, yaw} and `convention` (counter_clockwise_from_x or clockwise_from_north),
/// both optional, as the file is. Throws InputError with file and line.
SensorYaml read_sensor_yaml(const std::filesystem::path& path);

}  // namespace fathom
