#include "fathom/geometry/quaternion_order.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {
namespace {

using Poses = std::span<const StampedSpatialPose>;

constexpr double kTilt = 0.1;  // sine of half the angle: 11°

// The same four numbers, the scalar taken from the other end.
Eigen::Quaterniond in_other_order(const Eigen::Quaterniond& q, TrajectoryFormat format) {
  if (format == TrajectoryFormat::tum) return {q.x(), q.y(), q.z(), q.w()};
  return {q.z(), q.w(), q.x(), q.y()};
}

bool is_tilted(const Eigen::Quaterniond& q) {
  return std::hypot(q.x(), q.y()) > kTilt * q.norm();
}

// The motion is next to a plane z = constant, and no line in it.
bool is_level(Poses poses) {
  constexpr double kFlat = 0.2;
  Eigen::AlignedBox3d box;
  for (const StampedSpatialPose& pose : poses) box.extend(pose.pose.position_m);
  const Eigen::Vector3d extent_m = box.sizes();
  return extent_m.z() < kFlat * std::min(extent_m.x(), extent_m.y());
}

}  // namespace

void require_order(Poses poses, TrajectoryFormat format, const std::string& name) {
  constexpr std::size_t kFewest = 5;
  if (poses.size() < kFewest || !is_level(poses)) return;
  const double first_rad = yaw_of(in_other_order(poses.front().pose.rotation, format));
  std::size_t tilted = 0;
  std::size_t planar = 0;
  double most_rad = 0.0;
  for (const StampedSpatialPose& pose : poses) {
    const Eigen::Quaterniond other = in_other_order(pose.pose.rotation, format);
    tilted += is_tilted(pose.pose.rotation) ? 1 : 0;
    planar += is_tilted(other) ? 0 : 1;
    most_rad = std::max(most_rad, std::abs(wrap_angle(yaw_of(other) - first_rad)));
  }
  constexpr double kNearlyAll = 0.95;
  constexpr double kSeveral = 0.2;
  constexpr double kTurn = 0.5;
  const auto count = static_cast<double>(poses.size());
  if (static_cast<double>(planar) < kNearlyAll * count ||
      static_cast<double>(tilted) < kSeveral * count || most_rad < kTurn) {
    return;
  }
  const bool is_tum = format == TrajectoryFormat::tum;
  throw InputError(
      name, fmt::format("its quaternions look like {}: so read, {} of {} turn about z alone, and "
                        "as {}, which {} has, {} tilt the body; expected column {}",
                        is_tum ? "qw qx qy qz" : "qx qy qz qw", planar, poses.size(),
                        is_tum ? "qx qy qz qw" : "qw qx qy qz", is_tum ? "TUM" : "EuRoC", tilted,
                        is_tum ? "5 behind column 8" : "8 before column 5"));
}

}  // namespace fathom
