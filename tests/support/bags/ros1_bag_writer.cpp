// C++17: the message classes of ROS use what C++20 took out of std::allocator.

#include "support/bags/bag_writer.hpp"

#ifdef FATHOM_ROSBAG

#include <geometry_msgs/PointStamped.h>
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <sensor_msgs/CameraInfo.h>
#include <sensor_msgs/CompressedImage.h>
#include <sensor_msgs/Image.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/Range.h>
#include <std_msgs/Float64.h>
#include <std_msgs/String.h>

namespace fathom::test {

/// A tf2_msgs/TFMessage, whose class Debian's libraries of messages do not have.
struct TransformMessage {
  std::vector<geometry_msgs::TransformStamped> transforms;
};

}  // namespace fathom::test

namespace ros {
namespace message_traits {
template <>
struct MD5Sum<fathom::test::TransformMessage> {
  static const char* value(const fathom::test::TransformMessage& /*message*/) {
    return "94810edda583a504dfda3829e70d7eec";
  }
};
template <>
struct DataType<fathom::test::TransformMessage> {
  static const char* value(const fathom::test::TransformMessage& /*message*/) {
    return "tf2_msgs/TFMessage";
  }
};
template <>
struct Definition<fathom::test::TransformMessage> {
  static const char* value(const fathom::test::TransformMessage& /*message*/) {
    return "geometry_msgs/TransformStamped[] transforms\n";
  }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<fathom::test::TransformMessage> {
  template <class Stream, class Message>
  static void allInOne(Stream& stream, Message message) {
    stream.next(message.transforms);
  }
  ROS_DECLARE_ALLINONE_SERIALIZER
};
}  // namespace serialization
}  // namespace ros

namespace fathom::test {
namespace {

ros::Time time_of(std::int64_t nanoseconds) {
  ros::Time time;
  return time.fromNSec(static_cast<std::uint64_t>(nanoseconds));
}

template <class Rotation>
void set_rotation(Rotation& to, const std::array<double, 4>& from) {
  to.x = from[0];
  to.y = from[1];
  to.z = from[2];
  to.w = from[3];
}

geometry_msgs::Pose pose_of(const BodyPose& body) {
  geometry_msgs::Pose pose;
  pose.position.x = body.position[0];
  pose.position.y = body.position[1];
  pose.position.z = body.position[2];
  set_rotation(pose.orientation, body.rotation);
  return pose;
}

template <class From, class To>
void copy(const From& from, To& to) {
  for (std::size_t i = 0; i < from.size(); ++i) to[i] = from[i];
}

class Ros1BagWriter : public BagWriter {
 public:
  Ros1BagWriter(const std::filesystem::path& path, BagCompression compression)
      : bag_(path.string(), rosbag::bagmode::Write) {
    if (compression == BagCompression::bz2) bag_.setCompression(rosbag::compression::BZ2);
    if (compression == BagCompression::lz4) bag_.setCompression(rosbag::compression::LZ4);
  }

  void image(const std::string& topic, Stamps stamps, const RawImage& from) override {
    sensor_msgs::Image image;
    image.height = from.height;
    image.width = from.width;
    image.encoding = from.encoding;
    image.is_bigendian = from.is_bigendian ? 1 : 0;
    image.step = from.step;
    image.data = from.data;
    write(topic, stamps, image);
  }
  void compressed_image(const std::string& topic, Stamps stamps, const std::string& format,
                        const std::vector<std::uint8_t>& data) override {
    sensor_msgs::CompressedImage image;
    image.format = format;
    image.data = data;
    write(topic, stamps, image);
  }
  void camera_info(const std::string& topic, Stamps stamps,
                   const CameraInformation& from) override {
    sensor_msgs::CameraInfo info;
    info.height = from.height;
    info.width = from.width;
    info.distortion_model = from.distortion_model;
    info.D = from.D;
    copy(from.K, info.K);
    copy(from.P, info.P);
    info.binning_x = info.binning_y = from.binning;
    info.roi.x_offset = from.x_offset;
    info.roi.y_offset = from.y_offset;
    info.roi.height = from.region_height;
    info.roi.width = from.region_width;
    write(topic, stamps, info);
  }
  void range(const std::string& topic, Stamps stamps, const RangeReading& from) override {
    sensor_msgs::Range range;
    range.range = from.range;
    range.min_range = from.least;
    range.max_range = from.most;
    write(topic, stamps, range);
  }
  void point(const std::string& topic, Stamps stamps, const std::array<double, 3>& from) override {
    geometry_msgs::PointStamped point;
    point.point.x = from[0];
    point.point.y = from[1];
    point.point.z = from[2];
    write(topic, stamps, point);
  }
  void float64(const std::string& topic, Stamps stamps, double value) override {
    std_msgs::Float64 message;
    message.data = value;
    bag_.write(topic, time_of(stamps.record_ns), message);
  }
  void odometry(const std::string& topic, Stamps stamps, const BodyPose& body) override {
    nav_msgs::Odometry odometry;
    odometry.child_frame_id = "base_link";
    odometry.pose.pose = pose_of(body);
    copy(body.covariance, odometry.pose.covariance);
    copy(body.velocity_covariance, odometry.twist.covariance);
    write(topic, stamps, odometry);
  }
  void pose(const std::string& topic, Stamps stamps, const BodyPose& body) override {
    geometry_msgs::PoseStamped pose;
    pose.pose = pose_of(body);
    write(topic, stamps, pose);
  }
  void pose_with_covariance(const std::string& topic, Stamps stamps,
                            const BodyPose& body) override {
    geometry_msgs::PoseWithCovarianceStamped pose;
    pose.pose.pose = pose_of(body);
    copy(body.covariance, pose.pose.covariance);
    write(topic, stamps, pose);
  }
  void imu(const std::string& topic, Stamps stamps, const std::array<double, 4>& rotation,
           const std::array<double, 9>& covariance) override {
    sensor_msgs::Imu imu;
    set_rotation(imu.orientation, rotation);
    copy(covariance, imu.orientation_covariance);
    write(topic, stamps, imu);
  }
  void transforms(const std::string& topic, Stamps stamps,
                  const std::vector<FramePlace>& places) override {
    TransformMessage message;
    for (const FramePlace& place : places) {
      geometry_msgs::TransformStamped one;
      one.header.stamp = time_of(stamps.header_ns);
      one.header.frame_id = place.parent;
      one.child_frame_id = place.child;
      one.transform.translation.x = place.translation[0];
      one.transform.translation.y = place.translation[1];
      one.transform.translation.z = place.translation[2];
      set_rotation(one.transform.rotation, place.rotation);
      message.transforms.push_back(one);
    }
    bag_.write(topic, time_of(stamps.record_ns), message);
  }
  void word(const std::string& topic, Stamps stamps, const std::string& word) override {
    std_msgs::String message;
    message.data = word;
    bag_.write(topic, time_of(stamps.record_ns), message);
  }

 private:
  template <class Message>
  void write(const std::string& topic, Stamps stamps, Message& message) {
    message.header.seq = ++sequence_;
    message.header.stamp = time_of(stamps.header_ns);
    message.header.frame_id = kBagFrame;
    bag_.write(topic, time_of(stamps.record_ns), message);
  }

  rosbag::Bag bag_;
  std::uint32_t sequence_ = 0;
};

}  // namespace

std::unique_ptr<BagWriter> ros1_bag_writer(const std::filesystem::path& path,
                                           BagCompression compression) {
  return std::make_unique<Ros1BagWriter>(path, compression);
}

}  // namespace fathom::test

#else

namespace fathom::test {

std::unique_ptr<BagWriter> ros1_bag_writer(const std::filesystem::path& /*path*/,
                                           BagCompression /*compression*/) {
  return nullptr;
}

}  // namespace fathom::test

#endif
