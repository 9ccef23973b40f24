#pragma once

#include "fathom/vision/camera.hpp"

namespace fathom::test {

/// A camera of small pictures, 400 × 300, in the middle of the vehicle.
inline CameraModel small_model() {
  CameraModel model;
  model.width = 400;
  model.height = 300;
  model.fx = model.fy = 350.0;
  model.cx = 199.5;
  model.cy = 149.5;
  return model;
}

}  // namespace fathom::test
