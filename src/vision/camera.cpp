#include "fathom/vision/camera.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>

#include "distortion.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {
namespace {

void require_sound(const Stance& stance) {
  if (!(stance.altitude_m > 0.0) || !std::isfinite(stance.altitude_m)) {
    throw InputError("altitude must be a number of metres above zero, got " +
                     std::to_string(stance.altitude_m));
  }
  if (!std::isfinite(stance.tilt.roll_rad) || !std::isfinite(stance.tilt.pitch_rad)) {
    throw InputError("roll and pitch must be finite numbers of radians");
  }
}

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// The sines of a level camera would be computed for nothing.
Eigen::Matrix3d rotation_of(const Stance& stance) {
  return stance.is_level() ? Eigen::Matrix3d::Identity() : stance.tilt.rotation();
}

Eigen::Vector3d downward(const Eigen::Vector2d& level_ray) {
  return {level_ray.x(), level_ray.y(), -1.0};
}

// Where a direction meets a plane one metre below; NaN where it never does.
Eigen::Vector2d one_metre_below(const Eigen::Vector3d& direction) {
  if (!(direction.z() < 0.0)) return {kNaN, kNaN};
  return direction.head<2>() / -direction.z();
}

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

// Where a level camera a metre above the floor sees a pixel, from the point below it, body frame.
Eigen::Vector2d Camera::level_ray(const Eigen::Vector2d& pixel) const {
  Eigen::Vector2d image((pixel.x() - model_.cx) / model_.fx, (pixel.y() - model_.cy) / model_.fy);
  if (model_.has_distortion()) {
    image = undistort(model_.distortion, image).value_or(Eigen::Vector2d(kNaN, kNaN));
  }
  return body_from_mount_ * Eigen::Vector2d(-image.y(), -image.x());
}

Eigen::Vector2d Camera::on_floor(const Eigen::Vector2d& pixel, const Stance& stance,
                                 const Eigen::Matrix3d& tilt) const {
  Eigen::Vector2d ray = level_ray(pixel);
  if (!stance.is_level()) ray = one_metre_below(tilt * downward(ray));
  return ray * stance.altitude_m + Eigen::Vector2d(model_.mount_x_m, model_.mount_y_m);
}

Eigen::Vector2d Camera::floor_point(const Eigen::Vector2d& pixel, const Stance& stance) const {
  require_sound(stance);
  return on_floor(pixel, stance, rotation_of(stance));
}

std::vector<Eigen::Vector2d> Camera::floor_points(std::span<const Eigen::Vector2d> pixels,
                                                  const Stance& stance) const {
  require_sound(stance);
  const Eigen::Matrix3d tilt = rotation_of(stance);
  std::vector<Eigen::Vector2d> points;
  points.reserve(pixels.size());
  for (const Eigen::Vector2d& pixel : pixels) points.push_back(on_floor(pixel, stance, tilt));
  return points;
}

double Camera::heading(double turn_rad) const {
  const Eigen::Vector2d way = body_from_mount_ * Eigen::Vector2d(-std::sin(turn_rad) / model_.fy,
                                                                 -std::cos(turn_rad) / model_.fx);
  return std::atan2(way.y(), way.x());
}

// With g = R (b, −1) the ray b meets the floor at g_xy / −g_z, so a step db moves that point along
// dg_xy (−g_z) + g_xy dg_z, dg = R (db, 0); and areas there grow by det R / (−g_z)³.
Camera::Neighbourhood Camera::neighbourhood(const Eigen::Vector2d& pixel, double turn_rad,
                                            const Tilt& tilt) const {
  if (tilt.is_level()) return {heading(turn_rad), 1.0};
  const Eigen::Matrix3d R = tilt.rotation();
  const Eigen::Vector3d g = R * downward(level_ray(pixel));
  const double level = heading(turn_rad);
  const Eigen::Vector3d dg = R * Eigen::Vector3d(std::cos(level), std::sin(level), 0.0);
  const Eigen::Vector2d way = dg.head<2>() * -g.z() + g.head<2>() * dg.z();
  return {std::atan2(way.y(), way.x()), std::pow(-g.z(), -1.5)};
}

Eigen::Vector2d Camera::pixel(const Eigen::Vector2d& floor_point, const Stance& stance) const {
  require_sound(stance);
  const Eigen::Vector2d mount(model_.mount_x_m, model_.mount_y_m);
  Eigen::Vector2d from_mount = floor_point - mount;
  if (!stance.is_level()) {
    const Eigen::Vector2d ray = from_mount / stance.altitude_m;
    from_mount =
        stance.altitude_m * one_metre_below(stance.tilt.rotation().transpose() * downward(ray));
  }
  const Eigen::Vector2d seen = body_from_mount_.transpose() * from_mount / stance.altitude_m;
  const Eigen::Vector2d image = distort(model_.distortion, {-seen.y(), -seen.x()});
  return {model_.cx + model_.fx * image.x(), model_.cy + model_.fy * image.y()};
}

std::array<Eigen::Vector2d, 4> Camera::footprint(const Stance& stance) const {
  const double right = model_.width - 0.5;
  const double bottom = model_.height - 0.5;
  const std::array<Eigen::Vector2d, 4> corners{
      floor_point({-0.5, -0.5}, stance), floor_point({right, -0.5}, stance),
      floor_point({right, bottom}, stance), floor_point({-0.5, bottom}, stance)};
  if (!stance.is_level() && !std::ranges::all_of(corners, &Eigen::Vector2d::allFinite)) {
    throw InputError(fmt::format("a camera tilted by {:f} and {:f} rad sees the horizon",
                                 stance.tilt.roll_rad, stance.tilt.pitch_rad));
  }
  return corners;
}

}  // namespace fathom
