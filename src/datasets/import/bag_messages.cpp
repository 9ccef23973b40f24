#include "bag_messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

std::int64_t read_header(MessageReader& reader, std::string* frame = nullptr) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  reader.skip_sequence_number();
  const auto seconds = static_cast<std::int32_t>(reader.u32());
  const std::uint32_t nanoseconds = reader.u32();
  std::string frame_id = reader.text();
  if (frame != nullptr) *frame = std::move(frame_id);
  return seconds * kSecond + nanoseconds;
}

template <class Numbers>
void read_numbers(MessageReader& reader, Numbers& numbers) {
  for (double& number : numbers) number = reader.f64();
}

Eigen::Vector3d read_vector(MessageReader& reader) {
  const double x = reader.f64();
  const double y = reader.f64();
  const double z = reader.f64();
  return {x, y, z};
}

Eigen::Quaterniond read_rotation(MessageReader& reader) {
  const Eigen::Vector3d imaginary = read_vector(reader);
  return {reader.f64(), imaginary.x(), imaginary.y(), imaginary.z()};
}

Matrix6 read_covariance(MessageReader& reader) {
  Matrix6 covariance;
  for (int i = 0; i < covariance.size(); ++i) covariance.data()[i] = reader.f64();
  return covariance;
}

std::uint32_t read_size(MessageReader& reader) {
  constexpr std::uint32_t kMost = 1000;
  const std::uint32_t size = reader.u32();
  if (size > kMost) throw InputError("a message has a list of an impossible length");
  return size;
}

std::vector<double> read_sequence(MessageReader& reader) {
  std::vector<double> numbers(read_size(reader));
  read_numbers(reader, numbers);
  return numbers;
}

}  // namespace

ImageMessage read_image(MessageReader& reader) {
  ImageMessage image;
  image.stamp_ns = read_header(reader, &image.frame);
  image.height = reader.u32();
  image.width = reader.u32();
  image.encoding = reader.text();
  image.is_bigendian = reader.u8() != 0;
  image.step = reader.u32();
  image.data = reader.bytes();
  return image;
}

CompressedImageMessage read_compressed_image(MessageReader& reader) {
  CompressedImageMessage image;
  image.stamp_ns = read_header(reader, &image.frame);
  image.format = reader.text();
  image.data = reader.bytes();
  return image;
}

CameraInfoMessage read_camera_info(MessageReader& reader) {
  CameraInfoMessage info;
  info.stamp_ns = read_header(reader);
  info.height = reader.u32();
  info.width = reader.u32();
  info.distortion_model = reader.text();
  info.D = read_sequence(reader);
  std::array<double, 9> rectification{};
  read_numbers(reader, info.K);
  read_numbers(reader, rectification);
  read_numbers(reader, info.P);
  info.binning_x = reader.u32();
  info.binning_y = reader.u32();
  info.x_offset = reader.u32();
  info.y_offset = reader.u32();
  info.region_height = reader.u32();
  info.region_width = reader.u32();
  return info;
}

ScalarMessage read_scalar(const std::string& type, int axis, MessageReader& reader) {
  if (type == "std_msgs/Float64") return {std::nullopt, reader.f64()};
  if (type == "std_msgs/Float32") return {std::nullopt, reader.f32()};
  ScalarMessage scalar;
  scalar.stamp_ns = read_header(reader);
  if (type == "geometry_msgs/PointStamped") {
    scalar.value = read_vector(reader)[axis];
    return scalar;
  }
  reader.u8();   // radiation_type
  reader.f32();  // field_of_view
  const float least = reader.f32();
  const float most = reader.f32();
  const float range = reader.f32();
  const bool is_bounded = most > least;
  const bool is_inside = !is_bounded || (range >= least && range <= most);
  scalar.value = is_inside ? range : std::numeric_limits<double>::quiet_NaN();
  return scalar;
}

PoseMessage read_pose(const std::string& type, MessageReader& reader) {
  PoseMessage pose;
  pose.stamp_ns = read_header(reader);
  if (type == "nav_msgs/Odometry") pose.child_frame = reader.text();
  pose.position = read_vector(reader);
  pose.rotation = read_rotation(reader);
  if (type == "geometry_msgs/PoseStamped") return pose;
  pose.pose_covariance = read_covariance(reader);
  if (type != "nav_msgs/Odometry") return pose;
  read_vector(reader);  // linear velocity
  read_vector(reader);  // angular velocity
  pose.velocity_covariance = read_covariance(reader);
  return pose;
}

ImuMessage read_imu(MessageReader& reader) {
  ImuMessage imu;
  imu.stamp_ns = read_header(reader);
  imu.rotation = read_rotation(reader);
  std::array<double, 9> covariance{};
  read_numbers(reader, covariance);
  // By the definition, -1 in the first place says that there is no orientation. Many drivers leave
  // the quaternion at zero in place of that.
  imu.has_rotation = covariance.front() != -1.0 && imu.rotation.norm() > 0.0;
  imu.is_default = imu.rotation.coeffs() == Eigen::Vector4d(0.0, 0.0, 0.0, 1.0) &&
                   std::ranges::count(covariance, 0.0) == std::ssize(covariance);
  imu.yaw_variance = covariance.back();
  const auto [less, more] = std::minmax(covariance[0], covariance[4]);
  imu.tilt_variance = less > 0.0 ? more : less;
  return imu;
}

std::vector<FrameTransform> read_transforms(MessageReader& reader) {
  std::vector<FrameTransform> transforms(read_size(reader));
  for (FrameTransform& transform : transforms) {
    read_header(reader, &transform.parent);
    transform.child = reader.text();
    transform.translation = read_vector(reader);
    transform.rotation = read_rotation(reader);
  }
  return transforms;
}

std::optional<std::string_view> known_md5(const std::string& type) {
  static const std::map<std::string, std::string_view> sums{
      {"sensor_msgs/Image", "060021388200f6f0f447d0fcd9c64743"},
      {"sensor_msgs/CompressedImage", "8f7a12909da2c9d3332d540a0977563f"},
      {"sensor_msgs/CameraInfo", "c9a58c1b0b154e0e6da7578cb991d214"},
      {"sensor_msgs/Range", "c005c34273dc426c67a020a87bc24148"},
      {"sensor_msgs/Imu", "6a62c6daae103f4ff57a132d6f95cec2"},
      {"geometry_msgs/PointStamped", "c63aecb41bfdfd6b7e1fac37c7cbe7bf"},
      {"geometry_msgs/PoseStamped", "d3812c3cbc69362b77dc0b19b345f8f5"},
      {"geometry_msgs/PoseWithCovarianceStamped", "953b798c0f514ff060a53a3498ce6246"},
      {"std_msgs/Float32", "73fcbf46b49191e672908e50842a83d4"},
      {"std_msgs/Float64", "fdb28210bfa9d7c91146260178d9a584"},
      {"tf/tfMessage", "94810edda583a504dfda3829e70d7eec"},
      {"tf2_msgs/TFMessage", "94810edda583a504dfda3829e70d7eec"},
      {"nav_msgs/Odometry", "cd5e73d190d741a2f92e81eda573aca7"}};
  const auto found = sums.find(type);
  if (found == sums.end()) return std::nullopt;
  return found->second;
}

}  // namespace fathom
