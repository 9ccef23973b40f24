#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace fathom {

/// A pose in space: where a body is in the world, metres, and the rotation from its axes to the
/// world's. The quaternion is as its file has it, of a squared length between 0.5 and 2: who turns
/// something by it normalises it first.
struct SpatialPose {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};

struct StampedSpatialPose {
  std::int64_t time_ns = 0;
  SpatialPose pose;
};

/// The formats of trajectories (docs/formats.md).
enum class TrajectoryFormat {
  tum,    ///< `t x y z qx qy qz qw` a line, seconds; also with commas
  kitti,  ///< twelve numbers a line, the upper three rows of a 4×4 matrix by rows; no times
  euroc,  ///< CSV `t, x, y, z, qw, qx, qy, qz, …`, whole nanoseconds
};

/// Every format with the name it has in flags.
const std::vector<std::pair<std::string, TrajectoryFormat>>& trajectory_format_names();
/// As it is written in sentences: "TUM", "KITTI", "EuRoC".
std::string title_of(TrajectoryFormat format);

/// What a file says of a trajectory.
struct SpatialTrajectory {
  TrajectoryFormat format = TrajectoryFormat::tum;
  std::vector<StampedSpatialPose> poses;  ///< rising in time
  /// Whether the times are measured. Of KITTI poses without times the time is the index in seconds.
  bool has_times = true;
  /// EuRoC: columns beyond the eighth, as velocity and biases, which are not kept.
  std::size_t further_columns = 0;
};

struct TrajectorySource {
  std::filesystem::path path;
  /// Absent: by the first line that is no comment.
  std::optional<TrajectoryFormat> format;
  /// Times of KITTI poses, seconds, one a line; empty: none. Refused for another format.
  std::filesystem::path times;
};

/// Reads a trajectory of any format; `#` opens a comment. A file of comments alone is an empty TUM
/// trajectory where no format is given.
///
/// Throws InputError with file and line on a malformed line, a number that is not finite, a
/// quaternion far from unit length, quaternions that look like those of another order, a matrix
/// that is no rotation, decimal commas, times that do not rise (it says why), are no seconds (TUM)
/// or no whole nanoseconds (EuRoC), and on as many times as there are no poses.
SpatialTrajectory read_trajectory(const TrajectorySource& source);

/// The poses of a KITTI file, in its own axes: those of the camera, x right, y down, z forward, the
/// world being the camera of the first pose. The rotation is the one nearest to the matrix, which
/// may be off by 0.01 in any element of R Rᵀ. Throws InputError as read_trajectory.
std::vector<SpatialPose> read_kitti_poses(const std::filesystem::path& path);

/// Rising times in seconds, one a line, as the times.txt of KITTI; in nanoseconds. Throws
/// InputError with file and line.
std::vector<std::int64_t> read_times(const std::filesystem::path& path);

/// A whole file in the format. Numbers and times read back to the same bits. KITTI loses the times,
/// and its matrix is of the normalised quaternion: as exact as the format can be.
std::string to_text(std::span<const StampedSpatialPose> trajectory, TrajectoryFormat format);

/// What read_times reads.
std::string times_text(std::span<const StampedSpatialPose> trajectory);

/// The heading of the x axis of a body turned by q, counter-clockwise from the world's x axis seen
/// along −z: yaw of the angles yaw, pitch, roll. q need not be normalised. Where the x axis is
/// vertical it is open, and some number.
double yaw_of(const Eigen::Quaterniond& q);

}  // namespace fathom
