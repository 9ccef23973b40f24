#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "message_reader.hpp"

namespace fathom {

using Matrix6 = Eigen::Matrix<double, 6, 6, Eigen::RowMajor>;

/// What Fathom takes of each message, by the definitions of ROS's common_interfaces. `stamp_ns` is
/// that of the header.

/// sensor_msgs/Image; `data` refers to the message.
struct ImageMessage {
  std::int64_t stamp_ns = 0;
  std::string frame;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding;
  bool is_bigendian = false;
  std::uint32_t step = 0;  ///< bytes a row
  std::string_view data;
};
ImageMessage read_image(MessageReader& reader);

/// sensor_msgs/CompressedImage; `data` refers to the message.
struct CompressedImageMessage {
  std::int64_t stamp_ns = 0;
  std::string frame;
  std::string format;
  std::string_view data;
};
CompressedImageMessage read_compressed_image(MessageReader& reader);

/// sensor_msgs/CameraInfo. K and P are of the whole sensor, before binning.
struct CameraInfoMessage {
  std::int64_t stamp_ns = 0;
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model;
  std::vector<double> D;
  std::array<double, 9> K{};
  std::array<double, 12> P{};
  std::uint32_t binning_x = 0;  ///< 0 and 1: none
  std::uint32_t binning_y = 0;
  std::uint32_t x_offset = 0;  ///< of the region of interest
  std::uint32_t y_offset = 0;
  std::uint32_t region_height = 0;  ///< 0: the whole sensor
  std::uint32_t region_width = 0;
};
CameraInfoMessage read_camera_info(MessageReader& reader);

/// One number: of a Range, an axis of a PointStamped, a Float64 or Float32, which have no header.
/// Of a Range outside of its bounds it is NaN.
struct ScalarMessage {
  std::optional<std::int64_t> stamp_ns;
  double value = 0.0;
};
ScalarMessage read_scalar(const std::string& type, int axis, MessageReader& reader);

/// Odometry, PoseStamped or PoseWithCovarianceStamped: a pose in the frame of the header. Both
/// covariances are of (x, y, z, rotations about x, y, z); that of the pose in the axes of the
/// header's frame, that of the velocity in those of the body.
struct PoseMessage {
  std::int64_t stamp_ns = 0;
  std::string child_frame;  ///< of an Odometry: what moves
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  std::optional<Matrix6> pose_covariance;
  std::optional<Matrix6> velocity_covariance;
};
PoseMessage read_pose(const std::string& type, MessageReader& reader);

/// sensor_msgs/Imu.
struct ImuMessage {
  std::int64_t stamp_ns = 0;
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  double yaw_variance = 0.0;   ///< rad²; 0: not stated
  double tilt_variance = 0.0;  ///< rad², the larger one of roll and pitch; 0: not stated
  bool has_rotation = true;
  bool is_default = false;  ///< the identity without covariance, which a message has unless set
};
ImuMessage read_imu(MessageReader& reader);

/// One of a tf2_msgs/TFMessage or a tf/tfMessage: the pose of a child frame in its parent.
struct FrameTransform {
  std::string parent;
  std::string child;
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
};
std::vector<FrameTransform> read_transforms(MessageReader& reader);

/// The MD5 sum of the type's definition as it is read here; nothing for a type that is not read.
std::optional<std::string_view> known_md5(const std::string& type);

}  // namespace fathom
