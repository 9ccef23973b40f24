#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include "fathom/core/files.hpp"
#include "fathom/datasets/asl_files.hpp"
#include "pose_table.hpp"

namespace fathom {
namespace {

struct FloorPlane {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  bool is_by_view = false;
};

FloorPlane best_plane(const std::vector<CameraPose>& cameras) {
  // Of the second extent to the first: below it the centres lie along a line.
  constexpr double kLeastWidth = 0.01;
  FloorPlane plane;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();
  for (const CameraPose& camera : cameras) {
    plane.origin += camera.centre / static_cast<double>(cameras.size());
    up -= camera.axes.col(2);
  }
  up.normalize();
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const CameraPose& camera : cameras) {
    const Eigen::Vector3d offset = camera.centre - plane.origin;
    scatter += offset * offset.transpose();
  }
  // In rising order of the eigenvalues, which are squares of extents.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(scatter);
  const Eigen::Vector3d extents = axes.eigenvalues().cwiseMax(0.0).cwiseSqrt();
  const Eigen::Vector3d fitted = axes.eigenvectors().col(0);
  // A leg whose altitude changes by more than its width is best fitted by a plane that stands on
  // edge: what the cameras look at decides there.
  constexpr double kLeastCosine = 0.8660254037844386;  // 30 degrees
  if (extents[1] <= kLeastWidth * extents[2] || std::abs(fitted.dot(up)) < kLeastCosine) {
    const Eigen::Vector3d along = axes.eigenvectors().col(2);
    const bool is_line = extents[2] > 0.0;
    plane.normal = is_line ? Eigen::Vector3d(up - along * along.dot(up)).normalized() : up;
    plane.is_by_view = true;
    return plane;
  }
  plane.normal = fitted.dot(up) < 0.0 ? Eigen::Vector3d(-fitted) : fitted;
  return plane;
}

}  // namespace

PlanarCameras project_to_plane(const std::vector<CameraPose>& cameras) {
  const FloorPlane plane = best_plane(cameras);
  const Eigen::Vector3d& up = plane.normal;
  // The top of the picture is against its y axis.
  const auto forward = [&](const CameraPose& camera) {
    const Eigen::Vector3d top = -camera.axes.col(1);
    return Eigen::Vector3d(top - up * up.dot(top));
  };
  const Eigen::Vector3d x = forward(cameras.front()).normalized();
  const Eigen::Vector3d y = up.cross(x);
  PlanarCameras planar;
  planar.is_normal_by_view = plane.is_by_view;
  std::vector<double> tilts;
  double squares = 0.0;
  for (const CameraPose& camera : cameras) {
    const Eigen::Vector3d offset = camera.centre - cameras.front().centre;
    const Eigen::Vector3d top = forward(camera);
    planar.poses.push_back({offset.dot(x), offset.dot(y), std::atan2(top.dot(y), top.dot(x))});
    squares += std::pow((camera.centre - plane.origin).dot(up), 2);
    tilts.push_back(std::acos(std::clamp(-camera.axes.col(2).dot(up), -1.0, 1.0)));
  }
  planar.rms_off_plane = std::sqrt(squares / static_cast<double>(cameras.size()));
  std::ranges::sort(tilts);
  planar.most_tilt_rad = tilts.back();
  planar.median_tilt_rad = tilts[tilts.size() / 2];
  return planar;
}

void write_reference_poses(const std::vector<StampedPose>& poses,
                           const std::filesystem::path& folder) {
  std::string rows;
  for (const StampedPose& stamped : poses) {
    const Pose& pose = stamped.pose;
    rows += sensor_row(stamped.time_ns, {pose.x, pose.y, 0.0, std::cos(pose.theta / 2), 0.0, 0.0,
                                         std::sin(pose.theta / 2)});
  }
  write_reference(folder / "state_groundtruth_estimate0", rows);
  write_file(folder / "reference.tum", to_tum(poses));
}

}  // namespace fathom
