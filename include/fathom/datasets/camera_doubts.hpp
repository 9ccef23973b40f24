#pragma once

#include <string>
#include <vector>

#include "fathom/vision/camera.hpp"

namespace fathom {

/// Whether the principal point is far from the middle, and would be near it with its two numbers
/// exchanged.
bool principal_point_looks_exchanged(const CameraModel& camera);

/// What is unlike nearly all cameras, a line each that begins with `where`: focal lengths that
/// differ by more than 5 %, and a principal point that looks exchanged.
std::vector<std::string> camera_doubts(const CameraModel& camera, const std::string& where);

}  // namespace fathom
