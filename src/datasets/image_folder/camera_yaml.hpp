#pragma once

#include <filesystem>
#include <string>

#include "fathom/vision/camera.hpp"

namespace fathom {

/// Reads the `sensor.yaml` of a camera: `resolution`, `intrinsics` [fx, fy, cx, cy],
/// `distortion_model` (none or radial-tangential), `distortion_coefficients` (k1 k2 p1 p2, k3 if
/// given) and `mounting` {x, y, yaw}; m and rad. Other keys are not looked at, so files of
/// EuRoC itself are read. Throws InputError with file and line.
Camera read_camera_yaml(const std::filesystem::path& path);

/// The same, as text.
std::string camera_yaml(const CameraModel& model);

}  // namespace fathom
