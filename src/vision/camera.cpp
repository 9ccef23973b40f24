#include "fathom/vision/camera.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "distortion.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {
namespace {

void require_altitude(double altitude_m) {
  if (!(altitude_m > 0.0) || !std::isfinite(altitude_m)) {
    throw InputError("altitude must be a number of metres above zero, got " +
                     std::to_string(altitude_m));
  }
}

void require_numbers(const CameraModel& model) {
  if (model.width <= 0 || model.height <= 0) {
    throw InputError("camera resolution must be positive, got " + std::to_string(model.width) +
                     " x " + std::to_string(model.height));
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

// Distortion has its extremes at the border, but tangential terms and k3 of the other sign can fold
// the inside too: a coarse net over the whole picture is looked at.
void require_unfolded(const CameraModel& model) {
  constexpr int kCells = 16;
  for (int row = 0; row <= kCells; ++row) {
    for (int column = 0; column <= kCells; ++column) {
      const double u = -0.5 + model.width * column / static_cast<double>(kCells);
      const double v = -0.5 + model.height * row / static_cast<double>(kCells);
      if (!undistort(model.distortion, {(u - model.cx) / model.fx, (v - model.cy) / model.fy})) {
        throw InputError("camera distortion folds the picture over at pixel (" + std::to_string(u) +
                         ", " + std::to_string(v) + "); coefficients must be k1 k2 p1 p2 k3");
      }
    }
  }
}

}  // namespace

void CameraModel::add_to(Hash& hash) const {
  hash.add(width).add(height).add(fx).add(fy).add(cx).add(cy);
  for (const double coefficient : distortion) hash.add(coefficient);
  hash.add(mount_x_m).add(mount_y_m).add(mount_yaw_rad);
}

bool CameraModel::has_distortion() const {
  return std::ranges::any_of(distortion, [](double coefficient) { return coefficient != 0.0; });
}

Camera::Camera(const CameraModel& model)
    : model_(model), body_from_mount_(rotation(model.mount_yaw_rad)) {
  require_numbers(model_);
  if (model_.has_distortion()) require_unfolded(model_);
}

Eigen::Vector2d Camera::on_floor(const Eigen::Vector2d& pixel, double altitude_m) const {
  Eigen::Vector2d image((pixel.x() - model_.cx) / model_.fx, (pixel.y() - model_.cy) / model_.fy);
  if (model_.has_distortion()) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    image = undistort(model_.distortion, image).value_or(Eigen::Vector2d(kNaN, kNaN));
  }
  return body_from_mount_ * Eigen::Vector2d(-image.y(), -image.x()) * altitude_m +
         Eigen::Vector2d(model_.mount_x_m, model_.mount_y_m);
}

Eigen::Vector2d Camera::floor_point(const Eigen::Vector2d& pixel, double altitude_m) const {
  require_altitude(altitude_m);
  return on_floor(pixel, altitude_m);
}

std::vector<Eigen::Vector2d> Camera::floor_points(std::span<const Eigen::Vector2d> pixels,
                                                  double altitude_m) const {
  require_altitude(altitude_m);
  std::vector<Eigen::Vector2d> points;
  points.reserve(pixels.size());
  for (const Eigen::Vector2d& pixel : pixels) points.push_back(on_floor(pixel, altitude_m));
  return points;
}

double Camera::heading(double turn_rad) const {
  const Eigen::Vector2d way = body_from_mount_ * Eigen::Vector2d(-std::sin(turn_rad) / model_.fy,
                                                                 -std::cos(turn_rad) / model_.fx);
  return std::atan2(way.y(), way.x());
}

Eigen::Vector2d Camera::pixel(const Eigen::Vector2d& floor_point, double altitude_m) const {
  require_altitude(altitude_m);
  const Eigen::Vector2d mount(model_.mount_x_m, model_.mount_y_m);
  const Eigen::Vector2d seen = body_from_mount_.transpose() * (floor_point - mount) / altitude_m;
  const Eigen::Vector2d image = distort(model_.distortion, {-seen.y(), -seen.x()});
  return {model_.cx + model_.fx * image.x(), model_.cy + model_.fy * image.y()};
}

std::array<Eigen::Vector2d, 4> Camera::footprint(double altitude_m) const {
  const double right = model_.width - 0.5;
  const double bottom = model_.height - 0.5;
  return {floor_point({-0.5, -0.5}, altitude_m), floor_point({right, -0.5}, altitude_m),
          floor_point({right, bottom}, altitude_m), floor_point({-0.5, bottom}, altitude_m)};
}

}  // namespace fathom
