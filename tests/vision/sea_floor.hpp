#pragma once

#include "fathom/vision/registration.hpp"
#include "vision/textured_floor.hpp"

namespace fathom::test {

inline const TexturedFloor& sea_floor() {
  static const TexturedFloor floor(1200, 0.004, 5);
  return floor;
}

/// The features of that floor that a camera at the body's origin sees.
inline FloorFeatures seen_at(const Pose& pose, double altitude_m = 1.2) {
  CameraModel model;
  model.width = 400;
  model.height = 300;
  model.fx = model.fy = 350.0;
  model.cx = 199.5;
  model.cy = 149.5;
  const Camera camera(model);
  return on_floor(FeatureExtractor().extract(sea_floor().seen(camera, pose, altitude_m)), camera,
                  altitude_m);
}

}  // namespace fathom::test
