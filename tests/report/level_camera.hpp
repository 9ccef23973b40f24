#pragma once

#include "fathom/vision/camera.hpp"

namespace fathom::test {

/// At 2 m a picture of it covers 1.2 m ahead and behind of 1.6 m to both sides, 1 cm a pixel.
inline Camera camera() {
  CameraModel model;
  model.width = 160;
  model.height = 120;
  model.fx = model.fy = 200;
  model.cx = 79.5;
  model.cy = 59.5;
  return Camera(model);
}

}  // namespace fathom::test
