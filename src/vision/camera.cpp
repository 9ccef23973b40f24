#include "fathom/vision/camera.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <string>

#include <Eigen/LU>

#include "camera_checks.hpp"
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

void require_seen(std::span<const Eigen::Vector2d> points, const Stance& stance) {
  if (!stance.is_level() && !std::ranges::all_of(points, &Eigen::Vector2d::allFinite)) {
    throw InputError(fmt::format("a camera tilted by {:f} and {:f} rad sees the horizon",
                                 stance.tilt.roll_rad, stance.tilt.pitch_rad));
  }
}

}  // namespace

void CameraModel::add_to(Hash& hash) const {
  hash.add(width).add(height).add(fx).add(fy).add(cx).add(cy);
  constexpr std::size_t kRadialTangential = 5;
  for (std::size_t i = 0; i < kRadialTangential; ++i) hash.add(distortion[i]);
  hash.add(mount_x_m).add(mount_y_m).add(mount_yaw_rad);
  if (is_mirrored) hash.add("mirrored");
  // A lens of the first model has no more words, so that its keys are what they always were.
  if (distortion_model == DistortionModel::radial_tangential) return;
  hash.add(entry_of(distortion_model).name);
  for (std::size_t i = kRadialTangential; i < distortion.size(); ++i) hash.add(distortion[i]);
}

bool CameraModel::has_distortion() const {
  return distortion_model == DistortionModel::equidistant ||
         std::ranges::any_of(distortion, [](double coefficient) { return coefficient != 0.0; });
}

bool CameraModel::has_straight_sides() const {
  return distortion_model == DistortionModel::radial_tangential;
}

Camera::Camera(const CameraModel& model)
    : model_(model), body_from_mount_(rotation(model.mount_yaw_rad)) {
  require_camera(model_);
  reach_rad_ = reach_of(model_);
}

// The pixel in focal lengths from the axis, distortion undone.
Eigen::Vector2d Camera::image_point(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d image((pixel.x() - model_.cx) / model_.fx,
                              (pixel.y() - model_.cy) / model_.fy);
  if (!model_.has_distortion()) return image;
  return undistort(model_, reach_rad_, image).value_or(Eigen::Vector2d(kNaN, kNaN));
}

// Where a level camera a metre above the floor sees a pixel, from the point below it, body frame.
Eigen::Vector2d Camera::level_ray(const Eigen::Vector2d& pixel) const {
  return ray_of(image_point(pixel));
}

Eigen::Vector2d Camera::ray_of(const Eigen::Vector2d& image) const {
  const double left = model_.is_mirrored ? image.x() : -image.x();
  return body_from_mount_ * Eigen::Vector2d(-image.y(), left);
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
  return heading_of({std::cos(turn_rad) / model_.fx, std::sin(turn_rad) / model_.fy});
}

double Camera::heading_of(const Eigen::Vector2d& in_image) const {
  const Eigen::Vector2d way = ray_of(in_image);
  return std::atan2(way.y(), way.x());
}

Camera::Neighbourhood Camera::level_neighbourhood(const Eigen::Vector2d& pixel,
                                                  double turn_rad) const {
  if (model_.distortion_model == DistortionModel::radial_tangential) {
    return {heading(turn_rad), 1.0};
  }
  Eigen::Matrix2d distorted_ideal;
  distort(model_, image_point(pixel), &distorted_ideal);
  const Eigen::Vector2d shown(std::cos(turn_rad) / model_.fx, std::sin(turn_rad) / model_.fy);
  return {heading_of(distorted_ideal.inverse() * shown),
          1.0 / std::sqrt(distorted_ideal.determinant())};
}

// With g = R (b, −1) the ray b meets the floor at g_xy / −g_z, so a step db moves that point along
// dg_xy (−g_z) + g_xy dg_z, dg = R (db, 0); and areas there grow by det R / (−g_z)³.
Camera::Neighbourhood Camera::neighbourhood(const Eigen::Vector2d& pixel, double turn_rad,
                                            const Tilt& tilt) const {
  const Neighbourhood level = level_neighbourhood(pixel, turn_rad);
  if (tilt.is_level()) return level;
  const Eigen::Matrix3d R = tilt.rotation();
  const Eigen::Vector3d g = R * downward(level_ray(pixel));
  const Eigen::Vector3d dg =
      R * Eigen::Vector3d(std::cos(level.heading_rad), std::sin(level.heading_rad), 0.0);
  const Eigen::Vector2d way = dg.head<2>() * -g.z() + g.head<2>() * dg.z();
  return {std::atan2(way.y(), way.x()), level.stretch * std::pow(-g.z(), -1.5)};
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
  const double right = model_.is_mirrored ? seen.y() : -seen.y();
  const Eigen::Vector2d image = distort(model_, {right, -seen.x()});
  return {model_.cx + model_.fx * image.x(), model_.cy + model_.fy * image.y()};
}

std::array<Eigen::Vector2d, 4> Camera::footprint(const Stance& stance) const {
  const double far = model_.width - 0.5;
  const double left = model_.is_mirrored ? far : -0.5;
  const double right = model_.is_mirrored ? -0.5 : far;
  const double bottom = model_.height - 0.5;
  const std::array<Eigen::Vector2d, 4> corners{
      floor_point({left, -0.5}, stance), floor_point({right, -0.5}, stance),
      floor_point({right, bottom}, stance), floor_point({left, bottom}, stance)};
  require_seen(corners, stance);
  return corners;
}

std::vector<Eigen::Vector2d> Camera::outline(const Stance& stance, int steps) const {
  const double width = model_.width;
  const Eigen::Vector2d size(model_.is_mirrored ? -width : width, model_.height);
  const Eigen::Vector2d first(model_.is_mirrored ? width - 0.5 : -0.5, -0.5);
  const Eigen::Vector2d corners[] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}};
  std::vector<Eigen::Vector2d> points;
  points.reserve(4 * static_cast<std::size_t>(steps));
  for (int side = 0; side < 4; ++side) {
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector2d at =
          corners[side] + (corners[side + 1] - corners[side]) * (i / static_cast<double>(steps));
      points.push_back(floor_point(first + at.cwiseProduct(size), stance));
    }
  }
  require_seen(points, stance);
  return points;
}

}  // namespace fathom
