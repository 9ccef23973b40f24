#include "bag_picture.hpp"

#include <cstddef>
#include <cstring>
#include <fmt/format.h>
#include <map>
#include <string_view>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "fathom/vision/picture_codecs.hpp"

namespace fathom {
namespace {

constexpr int kAsItIs = -1;

// How an encoding of sensor_msgs/image_encodings.h lies in memory and becomes grey or BGR.
struct Encoding {
  int type = CV_8UC1;
  int conversion = kAsItIs;
};

const Encoding& encoding_of(const std::string& name) {
  // OpenCV names a Bayer mosaic by its second row and column, ROS by its first. YUV is of BT.601
  // with two pixels in four bytes; yuv422 is ROS's older name of uyvy.
  static const std::map<std::string, Encoding> encodings{
      {"mono8", {CV_8UC1, kAsItIs}},
      {"8UC1", {CV_8UC1, kAsItIs}},
      {"mono16", {CV_16UC1, kAsItIs}},
      {"16UC1", {CV_16UC1, kAsItIs}},
      {"bgr8", {CV_8UC3, kAsItIs}},
      {"8UC3", {CV_8UC3, kAsItIs}},
      {"rgb8", {CV_8UC3, cv::COLOR_RGB2BGR}},
      {"bgr16", {CV_16UC3, kAsItIs}},
      {"rgb16", {CV_16UC3, cv::COLOR_RGB2BGR}},
      {"bgra8", {CV_8UC4, cv::COLOR_BGRA2BGR}},
      {"rgba8", {CV_8UC4, cv::COLOR_RGBA2BGR}},
      {"bayer_rggb8", {CV_8UC1, cv::COLOR_BayerBG2BGR}},
      {"bayer_bggr8", {CV_8UC1, cv::COLOR_BayerRG2BGR}},
      {"bayer_gbrg8", {CV_8UC1, cv::COLOR_BayerGR2BGR}},
      {"bayer_grbg8", {CV_8UC1, cv::COLOR_BayerGB2BGR}},
      {"bayer_rggb16", {CV_16UC1, cv::COLOR_BayerBG2BGR}},
      {"bayer_bggr16", {CV_16UC1, cv::COLOR_BayerRG2BGR}},
      {"bayer_gbrg16", {CV_16UC1, cv::COLOR_BayerGR2BGR}},
      {"bayer_grbg16", {CV_16UC1, cv::COLOR_BayerGB2BGR}},
      {"uyvy", {CV_8UC2, cv::COLOR_YUV2BGR_UYVY}},
      {"yuv422", {CV_8UC2, cv::COLOR_YUV2BGR_UYVY}},
      {"yuyv", {CV_8UC2, cv::COLOR_YUV2BGR_YUY2}},
      {"yuv422_yuy2", {CV_8UC2, cv::COLOR_YUV2BGR_YUY2}}};
  const auto found = encodings.find(name);
  if (found != encodings.end()) return found->second;
  throw InputError("encoding " + in_quotes(name) +
                   " is not read; expected mono8, mono16, rgb8, bgr8, rgb16, bgr16, rgba8, bgra8, "
                   "bayer_…8, bayer_…16, uyvy (yuv422) or yuyv (yuv422_yuy2)");
}

void swap_bytes(cv::Mat& picture) {
  for (ushort& value : cv::Mat_<ushort>(picture)) {
    value = static_cast<ushort>((value << 8) | (value >> 8));
  }
}

// Grey, or colour in OpenCV's order, as a PNG.
BagPicture png_of(const cv::Mat& seen, int conversion) {
  cv::Mat picture = seen;
  if (conversion != kAsItIs) cv::cvtColor(seen, picture, conversion);
  std::string png = encode_picture(".png", picture);
  if (png.empty()) throw InputError("a picture cannot be encoded as PNG");
  return {".png", std::move(png), picture.cols, picture.rows};
}

// What was compressed as a Bayer mosaic, by a format such as "bayer_rggb8; png compressed"; what
// became colour before ("…; jpeg compressed bgr8") is none.
std::string mosaic_of(const std::string& format) {
  const std::string encoding(trim(format.substr(0, format.find(';'))));
  if (!encoding.starts_with("bayer_")) return {};
  const std::string mark = "compressed";
  const std::size_t at = format.find(mark);
  const std::string_view target =
      at == std::string::npos ? "" : trim(std::string_view(format).substr(at + mark.size()));
  return target.empty() || target == encoding ? encoding : "";
}

}  // namespace

BagPicture picture_of(const ImageMessage& message) {
  const Encoding& encoding = encoding_of(message.encoding);
  constexpr std::uint32_t kLargestSide = 100'000;
  const std::size_t row_bytes = std::size_t{message.width} * CV_ELEM_SIZE(encoding.type);
  const bool is_size = message.width > 0 && message.height > 0 && message.width <= kLargestSide &&
                       message.height <= kLargestSide;
  const bool is_whole =
      message.step >= row_bytes &&
      message.data.size() >= std::size_t{message.step} * (message.height - 1) + row_bytes;
  if (!is_size || !is_whole) {
    throw InputError(fmt::format("a picture of {} x {} pixels in {} bytes, {} a row, is not whole",
                                 message.width, message.height, message.data.size(), message.step));
  }
  if (encoding.type == CV_8UC2 && message.width % 2 != 0) {
    throw InputError(
        fmt::format("a picture of encoding {} is {} pixels wide; expected an even number",
                    in_quotes(message.encoding), message.width));
  }
  // Row by row: a message may put a row, and so a pixel of two bytes, at any place.
  cv::Mat seen(static_cast<int>(message.height), static_cast<int>(message.width), encoding.type);
  for (int row = 0; row < seen.rows; ++row) {
    std::memcpy(seen.ptr(row), message.data.data() + std::size_t{message.step} * row, row_bytes);
  }
  if (message.is_bigendian && seen.depth() == CV_16U) swap_bytes(seen);
  return png_of(seen, encoding.conversion);
}

BagPicture picture_of(const CompressedImageMessage& message) {
  using namespace std::string_view_literals;
  const bool is_jpeg = message.data.starts_with("\xFF\xD8"sv);
  if (!is_jpeg && !message.data.starts_with("\x89PNG"sv)) {
    throw InputError("format " + in_quotes(message.format) + " is not read; expected JPEG or PNG");
  }
  const cv::Mat picture = decode_grey_picture(message.data, "a compressed picture");
  if (const std::string mosaic = mosaic_of(message.format); !mosaic.empty()) {
    const cv::Mat seen = decode_picture(message.data);
    if (seen.channels() == 1) return png_of(seen, encoding_of(mosaic).conversion);
  }
  return {is_jpeg ? ".jpg" : ".png", std::string(message.data), picture.cols, picture.rows};
}

}  // namespace fathom
