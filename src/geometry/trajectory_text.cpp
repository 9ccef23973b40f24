// Trajectories as text.

#include "fathom/core/text.hpp"
#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {
namespace {

std::string in_a_row(std::initializer_list<double> values, const std::string& separator) {
  std::string text;
  for (const double value : values) text += separator + number_text(value);
  return text;
}

std::string tum_line(const StampedSpatialPose& stamped) {
  const auto& [p, q] = stamped.pose;
  return seconds_text(stamped.time_ns) +
         in_a_row({p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()}, " ") + '\n';
}

std::string euroc_line(const StampedSpatialPose& stamped) {
  const auto& [p, q] = stamped.pose;
  return std::to_string(stamped.time_ns) +
         in_a_row({p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}, ",") + '\n';
}

std::string kitti_line(const StampedSpatialPose& stamped) {
  const Eigen::Vector3d& p = stamped.pose.position_m;
  const Eigen::Matrix3d R = stamped.pose.rotation.normalized().toRotationMatrix();
  std::string line;
  for (int row = 0; row < 3; ++row) {
    line += in_a_row({R(row, 0), R(row, 1), R(row, 2), p(row)}, " ");
  }
  return line.substr(1) + '\n';
}

}  // namespace

std::string to_text(std::span<const StampedSpatialPose> trajectory, TrajectoryFormat format) {
  std::string text;
  if (format == TrajectoryFormat::tum) text = "# t x y z qx qy qz qw\n";
  if (format == TrajectoryFormat::euroc) {
    text = "#timestamp [ns],p_x [m],p_y [m],p_z [m],q_w [],q_x [],q_y [],q_z []\n";
  }
  for (const StampedSpatialPose& stamped : trajectory) {
    if (format == TrajectoryFormat::tum) text += tum_line(stamped);
    if (format == TrajectoryFormat::euroc) text += euroc_line(stamped);
    if (format == TrajectoryFormat::kitti) text += kitti_line(stamped);
  }
  return text;
}

std::string times_text(std::span<const StampedSpatialPose> trajectory) {
  std::string text;
  for (const StampedSpatialPose& stamped : trajectory) text += seconds_text(stamped.time_ns) + '\n';
  return text;
}

}  // namespace fathom
