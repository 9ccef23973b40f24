#pragma once

#include "fathom/vision/camera.hpp"

namespace fathom {

/// Throws InputError where Camera's constructor says so.
void require_camera(const CameraModel& model);

}  // namespace fathom
