#include "fathom/datasets/camera_options.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/input_error.hpp"

namespace fathom {

void CameraOptions::describe(OptionTable& table) {
  // Far beyond any camera; keeps a slip of the keyboard from filling the memory.
  constexpr double kLargestSide = 20'000;
  table.integer("width", base.width, Range::between(1, kLargestSide), "pixels", "picture width");
  table.integer("height", base.height, Range::between(1, kLargestSide), "pixels", "picture height");
  table.real("fx", base.fx, Range::positive(), "pixels", "focal length along the rows");
  table.real("fy", base.fy, Range::positive(), "pixels", "focal length along the columns");
  table.real_or_off("cx", cx, Range::any(), "pixels",
                    "column of the optical axis; off: the middle of the picture");
  table.real_or_off("cy", cy, Range::any(), "pixels",
                    "row of the optical axis; off: the middle of the picture");
  table.reals("distortion", distortion, 5, "",
              "radial-tangential distortion [k1, k2, p1, p2, k3]; []: none");
  table.real("mount_x_m", base.mount_x_m, Range::any(), "m", "camera ahead of the body's origin");
  table.real("mount_y_m", base.mount_y_m, Range::any(), "m", "camera to port of the body's origin");
  table.real("mount_yaw_rad", base.mount_yaw_rad, Range::any(), "rad",
             "turn of the camera, counter-clockwise from above; 0: picture top forward");
}

CameraModel CameraOptions::model(const std::string& key_prefix) const {
  CameraModel model = base;
  model.cx = cx.value_or((model.width - 1) / 2.0);
  model.cy = cy.value_or((model.height - 1) / 2.0);
  const bool finite = std::all_of(distortion.begin(), distortion.end(),
                                  [](double value) { return std::isfinite(value); });
  if (!finite || (!distortion.empty() && distortion.size() != model.distortion.size())) {
    throw InputError(key_prefix + "distortion: expected five numbers [k1, k2, p1, p2, k3], or []");
  }
  if (!distortion.empty()) std::ranges::copy(distortion, model.distortion.begin());
  return model;
}

}  // namespace fathom
