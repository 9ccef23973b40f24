#include "fathom/geometry/plane.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

using Trajectory = std::span<const StampedSpatialPose>;

// Rows: forward, left and up.
Eigen::Matrix3d named_axes(Plane plane) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (plane == Plane::xz) axes << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  if (plane == Plane::yz) axes << 0, 1, 0, 0, 0, 1, 1, 0, 0;
  return axes;
}

Eigen::Vector3d mean_position(Trajectory trajectory) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const StampedSpatialPose& stamped : trajectory) sum += stamped.pose.position_m;
  return sum / static_cast<double>(std::max<std::size_t>(trajectory.size(), 1));
}

// Mean of d dᵀ over the positions' distances d from their mean.
Eigen::Matrix3d spread(Trajectory trajectory) {
  const Eigen::Vector3d mean = mean_position(trajectory);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const StampedSpatialPose& stamped : trajectory) {
    const Eigen::Vector3d d = stamped.pose.position_m - mean;
    sum += d * d.transpose();
  }
  return sum / static_cast<double>(std::max<std::size_t>(trajectory.size(), 1));
}

PlaneAxes named(Plane plane) {
  return {plane, 0.0, named_axes(plane), named_axes(plane)};
}

PlaneAxes fitted(Trajectory trajectory, std::optional<Plane> next_to) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread(trajectory));
  const Eigen::Vector3d& squares = solver.eigenvalues();
  constexpr double kLine = 1e-12;
  if (!(squares(1) > kLine * squares(2))) {
    throw InputError(
        "--plane fit: the positions lie on a line, which is on many planes; name one: xy, xz or "
        "yz");
  }
  const Eigen::Vector3d normal = solver.eigenvectors().col(0);
  const auto cosine = [&](const Eigen::Matrix3d& of) { return std::abs(of.row(2).dot(normal)); };
  PlaneAxes axes = named(Plane::xy);
  for (const Plane plane : {Plane::xz, Plane::yz}) {
    if (cosine(named_axes(plane)) > cosine(axes.plane_from_world)) axes = named(plane);
  }
  // Two nearly the same planes half way between two named ones are seen from the same side.
  constexpr double kNear = 0.5;
  if (next_to && cosine(named_axes(*next_to)) >= kNear) axes = named(*next_to);
  Eigen::Vector3d up = axes.plane_from_world * normal;
  if (up.z() < 0.0) up = -up;
  const auto tilt = Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ());
  axes.tilt_rad = std::atan2(up.head<2>().norm(), up.z());
  axes.plane_from_world = tilt.toRotationMatrix() * axes.plane_from_world;
  return axes;
}

// From forward, left and up of the body to those of the plane.
Eigen::Matrix3d attitude(const SpatialPose& pose, const PlaneAxes& axes) {
  return axes.plane_from_world * pose.rotation.normalized().toRotationMatrix() *
         axes.level_from_body.transpose();
}

double height_rms(const Eigen::Matrix3d& spread, const Eigen::Vector3d& normal) {
  return std::sqrt(std::max(0.0, normal.dot(spread * normal)));
}

std::optional<Plane> better_plane(Trajectory trajectory, const PlaneAxes& chosen) {
  const Eigen::Matrix3d squares = spread(trajectory);
  const Eigen::Vector3d normal = chosen.plane_from_world.row(2);
  const double lost_m = height_rms(squares, normal);
  const double extent_m = std::sqrt(std::max(0.0, squares.trace() - lost_m * lost_m));
  if (!(lost_m > 0.1 * extent_m)) return std::nullopt;
  std::optional<Plane> better;
  double least_m = lost_m / 4.0;
  for (const Plane plane : {Plane::xy, Plane::xz, Plane::yz}) {
    const double other_m = height_rms(squares, named_axes(plane).row(2));
    if (other_m >= least_m) continue;
    least_m = other_m;
    better = plane;
  }
  return better;
}

}  // namespace

const std::vector<std::pair<std::string, Plane>>& plane_names() {
  static const std::vector<std::pair<std::string, Plane>> names{
      {"xy", Plane::xy}, {"xz", Plane::xz}, {"yz", Plane::yz}, {"fit", Plane::fit}};
  return names;
}

std::string name_of(Plane plane) {
  for (const auto& [name, value] : plane_names()) {
    if (value == plane) return name;
  }
  return "xy";
}

Plane usual_plane(TrajectoryFormat format) {
  return format == TrajectoryFormat::kitti ? Plane::xz : Plane::xy;
}

PlaneAxes axes_of(Plane plane, Trajectory trajectory, std::optional<Plane> next_to) {
  return plane == Plane::fit ? fitted(trajectory, next_to) : named(plane);
}

BodyAxes body_axes(Trajectory trajectory, const PlaneAxes& axes) {
  BodyAxes body;
  if (trajectory.empty()) return body;
  body.mean_up.setZero();
  for (const StampedSpatialPose& stamped : trajectory) {
    body.mean_up += attitude(stamped.pose, axes).row(2).transpose();
  }
  body.mean_up /= static_cast<double>(trajectory.size());
  Eigen::Index axis = 0;
  body.mean_up.cwiseAbs().maxCoeff(&axis);
  body.up = Eigen::Vector3d::Unit(axis) * (body.mean_up(axis) < 0.0 ? -1.0 : 1.0);
  if (axis == 0) body.forward = Eigen::Vector3d::UnitZ();
  return body;
}

Projection project(Trajectory trajectory, const PlaneAxes& axes, const BodyAxes& body) {
  constexpr double kVertical = 80.0 * std::numbers::pi / 180.0;
  Projection projection;
  ProjectionLoss& loss = projection.loss;
  const double mean_height_m = axes.plane_from_world.row(2).dot(mean_position(trajectory));
  const Eigen::Vector3d left = body.up.cross(body.forward);
  for (const auto& [time_ns, pose] : trajectory) {
    const Eigen::Vector3d p = axes.plane_from_world * pose.position_m;
    const Eigen::Matrix3d R = attitude(pose, axes);
    const Eigen::Vector3d forward = R * body.forward;
    const Eigen::Vector3d up_in_body = R.row(2);
    const double roll = std::atan2(up_in_body.dot(left), up_in_body.dot(body.up));
    const double pitch = -std::atan2(forward.z(), forward.head<2>().norm());
    projection.trajectory.push_back(
        {time_ns, {p.x(), p.y(), wrap_angle(std::atan2(forward.y(), forward.x()))}});
    projection.heights_m.push_back(p.z());
    const double height_m = p.z() - mean_height_m;
    loss.height_rms_m += height_m * height_m;
    loss.height_max_m = std::max(loss.height_max_m, std::abs(height_m));
    loss.roll_rms_rad += roll * roll;
    loss.pitch_rms_rad += pitch * pitch;
    if (std::abs(pitch) > kVertical) ++loss.open_headings;
  }
  loss.better = better_plane(trajectory, axes);
  const double count = static_cast<double>(std::max<std::size_t>(trajectory.size(), 1));
  for (double* square : {&loss.height_rms_m, &loss.roll_rms_rad, &loss.pitch_rms_rad}) {
    *square = std::sqrt(*square / count);
  }
  return projection;
}

std::vector<StampedSpatialPose> to_space(std::span<const StampedPose> trajectory) {
  std::vector<StampedSpatialPose> spatial;
  for (const auto& [time_ns, pose] : trajectory) {
    spatial.push_back(
        {time_ns,
         {{pose.x, pose.y, 0.0}, {std::cos(pose.theta / 2), 0, 0, std::sin(pose.theta / 2)}}});
  }
  return spatial;
}

}  // namespace fathom
