#include "fathom/datasets/camera_options.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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
  describe_distortion(table, "", base.distortion_model, distortion);
  table.real("mount_x_m", base.mount_x_m, Range::any(), "m", "camera ahead of the body's origin");
  table.real("mount_y_m", base.mount_y_m, Range::any(), "m", "camera to port of the body's origin");
  table.real("mount_yaw_rad", base.mount_yaw_rad, Range::any(), "rad",
             "turn of the camera, counter-clockwise from above; 0: picture top forward");
  table.boolean("mirrored", base.is_mirrored, "left and right are exchanged in the pictures");
}

CameraModel CameraOptions::model(const std::string& key_prefix) const {
  CameraModel model = base;
  model.cx = cx.value_or((model.width - 1) / 2.0);
  model.cy = cy.value_or((model.height - 1) / 2.0);
  set_distortion(model, distortion, key_prefix + "distortion");
  return model;
}

void describe_distortion(OptionTable& table, const std::string& prefix, DistortionModel& model,
                         std::vector<double>& coefficients) {
  std::vector<std::pair<std::string, DistortionModel>> names;
  for (const DistortionEntry& entry : distortion_models()) {
    names.emplace_back(entry.name, entry.model);
  }
  table.enumeration(prefix + "distortion_model", model, names,
                    "how the lens bends: OpenCV's formulas; a fisheye is equidistant");
  std::string lists;
  for (const DistortionEntry& entry : distortion_models()) {
    lists += (lists.empty() ? "" : ", ") + entry.name + " " + entry.list();
  }
  table.reals(prefix + "distortion", coefficients, 1, "", lists + "; []: all zero");
}

void set_distortion(CameraModel& camera, const std::vector<double>& coefficients,
                    const std::string& key) {
  const DistortionEntry& entry = entry_of(camera.distortion_model);
  const bool finite =
      std::ranges::all_of(coefficients, [](double value) { return std::isfinite(value); });
  if (!finite || (!coefficients.empty() && coefficients.size() != entry.coefficients.size())) {
    throw InputError(fmt::format("{}: expected the {} numbers {} of {} distortion, or []", key,
                                 entry.coefficients.size(), entry.list(), entry.name));
  }
  camera.distortion.fill(0.0);
  std::ranges::copy(coefficients, camera.distortion.begin());
}

}  // namespace fathom
