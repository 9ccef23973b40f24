#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace fathom::test {

/// When a message was recorded, and what its header says.
struct Stamps {
  std::int64_t record_ns = 0;
  std::int64_t header_ns = 0;
};

struct RawImage {
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string encoding = "mono8";
  bool is_bigendian = false;
  std::uint32_t step = 0;
  std::vector<std::uint8_t> data;
};

struct CameraInformation {
  std::uint32_t height = 0;
  std::uint32_t width = 0;
  std::string distortion_model = "plumb_bob";
  std::vector<double> D;
  std::array<double, 9> K{};
  std::array<double, 12> P{};
  std::uint32_t binning = 0;
  std::uint32_t x_offset = 0;
  std::uint32_t y_offset = 0;
  std::uint32_t region_height = 0;
  std::uint32_t region_width = 0;
};

struct RangeReading {
  float range = 0.0F;
  float least = 0.0F;
  float most = 0.0F;
};

/// Position, quaternion x y z w, and covariances of (x, y, z, rotations), row by row.
struct BodyPose {
  std::array<double, 3> position{};
  std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};
  std::array<double, 36> covariance{};
  std::array<double, 36> velocity_covariance{};
};

/// The frame of all headers.
inline constexpr const char* kBagFrame = "odd length";

/// Of tf: translation, and quaternion x y z w.
struct FramePlace {
  std::string parent;
  std::string child;
  std::array<double, 3> translation{};
  std::array<double, 4> rotation{0.0, 0.0, 0.0, 1.0};
};

/// Writes a bag from the definitions of the messages, independently of what Fathom reads with.
class BagWriter {
 public:
  virtual ~BagWriter() = default;
  virtual void image(const std::string& topic, Stamps stamps, const RawImage& image) = 0;
  virtual void compressed_image(const std::string& topic, Stamps stamps, const std::string& format,
                                const std::vector<std::uint8_t>& data) = 0;
  virtual void camera_info(const std::string& topic, Stamps stamps,
                           const CameraInformation& info) = 0;
  virtual void range(const std::string& topic, Stamps stamps, const RangeReading& reading) = 0;
  virtual void point(const std::string& topic, Stamps stamps,
                     const std::array<double, 3>& point) = 0;
  virtual void float64(const std::string& topic, Stamps stamps, double value) = 0;
  virtual void odometry(const std::string& topic, Stamps stamps, const BodyPose& pose) = 0;
  virtual void pose(const std::string& topic, Stamps stamps, const BodyPose& pose) = 0;
  virtual void pose_with_covariance(const std::string& topic, Stamps stamps,
                                    const BodyPose& pose) = 0;
  virtual void imu(const std::string& topic, Stamps stamps, const std::array<double, 4>& rotation,
                   const std::array<double, 9>& covariance) = 0;
  /// A tf2_msgs/TFMessage.
  virtual void transforms(const std::string& topic, Stamps stamps,
                          const std::vector<FramePlace>& places) = 0;
  /// A type that nobody imports.
  virtual void word(const std::string& topic, Stamps stamps, const std::string& word) = 0;
};

enum class BagCompression { none, bz2, lz4 };

/// By rosbag::Bag and the message classes of ROS; nothing where Fathom is built without librosbag.
std::unique_ptr<BagWriter> ros1_bag_writer(const std::filesystem::path& path,
                                           BagCompression compression = BagCompression::none);

/// A `.db3` with the tables of rosbag2 and CDR of our own.
std::unique_ptr<BagWriter> ros2_bag_writer(const std::filesystem::path& path,
                                           bool is_big_endian = false);

/// How messages are put into an MCAP file.
struct McapLayout {
  std::string compression{};  ///< of its chunks: "lz4", "zstd"; of another name they are empty
  bool is_chunked = true;
  bool has_sums = true;
  bool has_summary = true;
  std::size_t messages_in_chunk = 7;
};

/// The same messages as an `.mcap`.
std::unique_ptr<BagWriter> mcap_bag_writer(const std::filesystem::path& path,
                                           const McapLayout& layout = {});

}  // namespace fathom::test
