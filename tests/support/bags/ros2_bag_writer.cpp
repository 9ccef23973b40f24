// CDR as OMG's specification has it: four bytes that say the byte order, then each number at a
// multiple of its size from there on, texts and lists after their length.

#include <algorithm>
#include <bit>
#include <cstring>

#include "support/bags/bag_writer.hpp"
#include "support/bags/ros2_sink.hpp"

namespace fathom::test {
namespace {

class Cdr {
 public:
  explicit Cdr(bool is_big_endian) : is_big_endian_(is_big_endian) {
    bytes_ = {0, static_cast<std::uint8_t>(is_big_endian ? 0 : 1), 0, 0};
  }

  template <class Number>
  Cdr& number(Number value) {
    while ((bytes_.size() - 4) % sizeof value != 0) bytes_.push_back(0);
    std::array<std::uint8_t, sizeof value> raw{};
    std::memcpy(raw.data(), &value, sizeof value);
    if (is_big_endian_) std::reverse(raw.begin(), raw.end());
    bytes_.insert(bytes_.end(), raw.begin(), raw.end());
    return *this;
  }
  Cdr& u32(std::uint32_t value) { return number(value); }
  Cdr& u8(std::uint8_t value) { return number(value); }
  Cdr& text(const std::string& value) {
    u32(static_cast<std::uint32_t>(value.size() + 1));
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    return u8(0);
  }
  Cdr& list(const std::vector<std::uint8_t>& value) {
    u32(static_cast<std::uint32_t>(value.size()));
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    return *this;
  }
  template <class Numbers>
  Cdr& numbers(const Numbers& values) {
    for (const double value : values) number(value);
    return *this;
  }
  Cdr& header(std::int64_t time_ns, const std::string& frame = kBagFrame) {
    constexpr std::int64_t kSecond = 1'000'000'000;
    number(static_cast<std::int32_t>(time_ns / kSecond));
    return u32(static_cast<std::uint32_t>(time_ns % kSecond)).text(frame);
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  bool is_big_endian_;
  std::vector<std::uint8_t> bytes_;
};

class Ros2BagWriter : public BagWriter {
 public:
  Ros2BagWriter(std::unique_ptr<Ros2Sink> sink, bool is_big_endian)
      : is_big_endian_(is_big_endian), sink_(std::move(sink)) {}

  void image(const std::string& topic, Stamps stamps, const RawImage& image) override {
    Cdr cdr = headed(stamps);
    cdr.u32(image.height).u32(image.width).text(image.encoding);
    cdr.u8(image.is_bigendian ? 1 : 0).u32(image.step).list(image.data);
    write(topic, "sensor_msgs/msg/Image", stamps, cdr);
  }
  void compressed_image(const std::string& topic, Stamps stamps, const std::string& format,
                        const std::vector<std::uint8_t>& data) override {
    Cdr cdr = headed(stamps);
    write(topic, "sensor_msgs/msg/CompressedImage", stamps, cdr.text(format).list(data));
  }
  void camera_info(const std::string& topic, Stamps stamps,
                   const CameraInformation& info) override {
    Cdr cdr = headed(stamps);
    cdr.u32(info.height).u32(info.width).text(info.distortion_model);
    cdr.u32(static_cast<std::uint32_t>(info.D.size())).numbers(info.D);
    cdr.numbers(info.K).numbers(std::array<double, 9>{}).numbers(info.P);
    cdr.u32(info.binning).u32(info.binning).u32(info.x_offset).u32(info.y_offset);
    cdr.u32(info.region_height).u32(info.region_width).u8(0);
    write(topic, "sensor_msgs/msg/CameraInfo", stamps, cdr);
  }
  void range(const std::string& topic, Stamps stamps, const RangeReading& reading) override {
    Cdr cdr = headed(stamps);
    cdr.u8(0).number(0.1F).number(reading.least).number(reading.most).number(reading.range);
    write(topic, "sensor_msgs/msg/Range", stamps, cdr);
  }
  void point(const std::string& topic, Stamps stamps, const std::array<double, 3>& point) override {
    Cdr cdr = headed(stamps);
    write(topic, "geometry_msgs/msg/PointStamped", stamps, cdr.numbers(point));
  }
  void float64(const std::string& topic, Stamps stamps, double value) override {
    Cdr cdr(is_big_endian_);
    write(topic, "std_msgs/msg/Float64", stamps, cdr.number(value));
  }
  void odometry(const std::string& topic, Stamps stamps, const BodyPose& body) override {
    Cdr cdr = headed(stamps);
    cdr.text("base_link").numbers(body.position).numbers(body.rotation).numbers(body.covariance);
    cdr.numbers(std::array<double, 6>{}).numbers(body.velocity_covariance);
    write(topic, "nav_msgs/msg/Odometry", stamps, cdr);
  }
  void pose(const std::string& topic, Stamps stamps, const BodyPose& body) override {
    Cdr cdr = headed(stamps);
    write(topic, "geometry_msgs/msg/PoseStamped", stamps,
          cdr.numbers(body.position).numbers(body.rotation));
  }
  void pose_with_covariance(const std::string& topic, Stamps stamps,
                            const BodyPose& body) override {
    Cdr cdr = headed(stamps);
    write(topic, "geometry_msgs/msg/PoseWithCovarianceStamped", stamps,
          cdr.numbers(body.position).numbers(body.rotation).numbers(body.covariance));
  }
  void imu(const std::string& topic, Stamps stamps, const std::array<double, 4>& rotation,
           const std::array<double, 9>& covariance) override {
    Cdr cdr = headed(stamps);
    cdr.numbers(rotation).numbers(covariance).numbers(std::array<double, 24>{});
    write(topic, "sensor_msgs/msg/Imu", stamps, cdr);
  }
  void transforms(const std::string& topic, Stamps stamps,
                  const std::vector<FramePlace>& places) override {
    Cdr cdr(is_big_endian_);
    cdr.u32(static_cast<std::uint32_t>(places.size()));
    for (const FramePlace& place : places) {
      cdr.header(stamps.header_ns, place.parent).text(place.child);
      cdr.numbers(place.translation).numbers(place.rotation);
    }
    write(topic, "tf2_msgs/msg/TFMessage", stamps, cdr);
  }
  void word(const std::string& topic, Stamps stamps, const std::string& word) override {
    Cdr cdr(is_big_endian_);
    write(topic, "std_msgs/msg/String", stamps, cdr.text(word));
  }

 private:
  Cdr headed(Stamps stamps) const {
    Cdr cdr(is_big_endian_);
    return cdr.header(stamps.header_ns);
  }

  void write(const std::string& topic, const std::string& type, Stamps stamps, const Cdr& cdr) {
    sink_->write(topic, type, stamps.record_ns, cdr.bytes());
  }

  bool is_big_endian_;
  std::unique_ptr<Ros2Sink> sink_;
};

}  // namespace

std::unique_ptr<BagWriter> ros2_bag_writer(const std::filesystem::path& path, bool is_big_endian) {
  return std::make_unique<Ros2BagWriter>(sqlite_sink(path), is_big_endian);
}

std::unique_ptr<BagWriter> mcap_bag_writer(const std::filesystem::path& path,
                                           const McapLayout& layout) {
  return std::make_unique<Ros2BagWriter>(mcap_sink(path, layout), false);
}

}  // namespace fathom::test
