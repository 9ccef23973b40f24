#include "camera_checks.hpp"

#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "distortion.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

void require_numbers(const CameraModel& model) {
  if (model.width <= 0 || model.height <= 0) {
    throw InputError(
        fmt::format("camera resolution must be positive, got {} x {}", model.width, model.height));
  }
  if (!(model.fx > 0.0) || !(model.fy > 0.0) || !std::isfinite(model.fx) ||
      !std::isfinite(model.fy)) {
    throw InputError("camera focal lengths must be positive numbers of pixels, got " +
                     std::to_string(model.fx) + " and " + std::to_string(model.fy));
  }
  bool finite = true;
  for (const double number :
       {model.cx, model.cy, model.mount_x_m, model.mount_y_m, model.mount_yaw_rad}) {
    finite = finite && std::isfinite(number);
  }
  for (const double number : model.distortion) finite = finite && std::isfinite(number);
  if (!finite) {
    throw InputError("camera centre, distortion and mounting must be finite numbers");
  }
}

void require_own_coefficients(const CameraModel& model) {
  const DistortionEntry& entry = entry_of(model.distortion_model);
  for (std::size_t i = entry.coefficients.size(); i < model.distortion.size(); ++i) {
    if (model.distortion[i] != 0.0) {
      throw InputError("distortion " + entry.name + " has " +
                       std::to_string(entry.coefficients.size()) + " coefficients");
    }
  }
}

// Distortion has its extremes at the border, but tangential terms and k3 of the other sign can fold
// the inside too: a coarse net over the whole picture is looked at.
void require_one_ray_a_pixel(const CameraModel& model) {
  constexpr int kCells = 16;
  const double reach_rad = reach_of(model);
  for (int row = 0; row <= kCells; ++row) {
    for (int column = 0; column <= kCells; ++column) {
      const double u = -0.5 + model.width * column / static_cast<double>(kCells);
      const double v = -0.5 + model.height * row / static_cast<double>(kCells);
      const auto ideal =
          undistort(model, reach_rad, {(u - model.cx) / model.fx, (v - model.cy) / model.fy});
      if (ideal && is_unfolded(model, *ideal)) continue;
      if (model.distortion_model == DistortionModel::equidistant &&
          reach_rad == 0.5 * std::numbers::pi) {
        throw InputError(fmt::format(
            "camera sees 90 degrees or more from its axis at pixel ({:f}, {:f}), where no floor "
            "is: crop the pictures",
            u, v));
      }
      throw InputError(fmt::format(
          "camera distortion folds the picture over at pixel ({:f}, {:f}); coefficients must be {}",
          u, v, joined(entry_of(model.distortion_model).coefficients, " ")));
    }
  }
}

}  // namespace

void require_camera(const CameraModel& model) {
  require_numbers(model);
  require_own_coefficients(model);
  if (model.has_distortion()) require_one_ray_a_pixel(model);
}

}  // namespace fathom
