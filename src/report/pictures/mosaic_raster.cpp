#include "mosaic_raster.hpp"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "fathom/core/files.hpp"
#include "fathom/vision/picture_codecs.hpp"

namespace fathom {
namespace {

// A whole number of fine pixels at best, so that means are over as many.
double fitting_resolution(const cv::Size& size, double metres_per_pixel, double most_pixels) {
  const double pixels = static_cast<double>(size.width) * size.height;
  return metres_per_pixel * std::max(1.0, std::ceil(std::sqrt(pixels / most_pixels)));
}

unsigned char mean_of(float sum, int count) {
  if (count == 0) return kUnseen;
  const float mean = std::round(sum / static_cast<float>(count));
  return static_cast<unsigned char>(std::min(mean, kUnseen - 1.0F));
}

// The colour of a pixel that a and b show, or one of them, or none.
cv::Vec3b colour_of(unsigned char a, unsigned char b) {
  const auto pale = [](unsigned char grey) {
    const auto half = static_cast<unsigned char>((grey + 255) / 2);
    return cv::Vec3b(half, half, half);
  };
  if (a == kUnseen) return b == kUnseen ? cv::Vec3b(255, 255, 255) : pale(b);
  if (b == kUnseen) return pale(a);
  return {b, static_cast<unsigned char>((a + b) / 2), a};
}

}  // namespace

std::optional<MosaicRaster> read_mosaic(const std::filesystem::path& folder) {
  std::error_code ignored;
  for (const char* name : {"mosaic.json", "mosaic.png"}) {
    if (!std::filesystem::exists(folder / name, ignored)) return std::nullopt;
  }
  const auto json = nlohmann::json::parse(read_file(folder / "mosaic.json"), nullptr, false);
  const auto number = [&json](const char* key) -> double {
    return json.is_object() && json.contains(key) && json[key].is_number() ? json[key].get<double>()
                                                                           : std::nan("");
  };
  MosaicRaster mosaic;
  mosaic.metres_per_pixel = number("metres_per_pixel");
  mosaic.top_left_m = {number("x_of_top_left_m"), number("y_of_top_left_m")};
  if (!(mosaic.metres_per_pixel > 0.0) || !mosaic.top_left_m.allFinite()) return std::nullopt;
  // Further away its pixels would have no numbers.
  constexpr double kFarthestPixel = 1e8;
  const double farthest_m = kFarthestPixel * mosaic.metres_per_pixel;
  if (mosaic.top_left_m.cwiseAbs().maxCoeff() > farthest_m) return std::nullopt;
  mosaic.grey = decode_picture(read_file(folder / "mosaic.png"), cv::IMREAD_GRAYSCALE);
  const bool fits =
      mosaic.grey.cols == number("width_px") && mosaic.grey.rows == number("height_px");
  if (mosaic.grey.empty() || !fits) return std::nullopt;
  if (json.contains("blend") && json["blend"] == "seams") mosaic.blend = MosaicBlend::seams;
  return mosaic;
}

cv::Rect frame_of(const MosaicRaster& mosaic, double metres_per_pixel) {
  const double slack = 1e-6;  // a corner at a whole pixel, but for rounding
  const auto first = [&](double high_m) {
    return static_cast<int>(std::floor(-high_m / metres_per_pixel + slack));
  };
  const auto end = [&](double high_m, int count) {
    const double low_m = high_m - count * mosaic.metres_per_pixel;
    return static_cast<int>(std::ceil(-low_m / metres_per_pixel - slack));
  };
  const Eigen::Vector2d& corner = mosaic.top_left_m;
  return {cv::Point(first(corner.y()), first(corner.x())),
          cv::Point(end(corner.y(), mosaic.grey.cols), end(corner.x(), mosaic.grey.rows))};
}

MosaicRaster binned(const MosaicRaster& mosaic, double metres_per_pixel, const cv::Rect& frame) {
  MosaicRaster coarse{cv::Mat(frame.size(), CV_8U),
                      metres_per_pixel,
                      {-frame.y * metres_per_pixel, -frame.x * metres_per_pixel}};
  cv::Mat sum = cv::Mat::zeros(frame.size(), CV_32F);
  cv::Mat count = cv::Mat::zeros(frame.size(), CV_32S);
  const double ratio = mosaic.metres_per_pixel / metres_per_pixel;
  const Eigen::Vector2d first = coarse.pixel(mosaic.top_left_m);
  std::vector<int> column_of(static_cast<std::size_t>(mosaic.grey.cols));
  for (int u = 0; u < mosaic.grey.cols; ++u) {
    column_of[static_cast<std::size_t>(u)] =
        static_cast<int>(std::floor(first.x() + (u + 0.5) * ratio));
  }
  for (int v = 0; v < mosaic.grey.rows; ++v) {
    const int row = static_cast<int>(std::floor(first.y() + (v + 0.5) * ratio));
    if (row < 0 || row >= frame.height) continue;
    const unsigned char* grey = mosaic.grey.ptr(v);
    for (int u = 0; u < mosaic.grey.cols; ++u) {
      const int column = column_of[static_cast<std::size_t>(u)];
      if (grey[u] == kUnseen || column < 0 || column >= frame.width) continue;
      sum.ptr<float>(row)[column] += grey[u];
      ++count.ptr<int>(row)[column];
    }
  }
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      coarse.grey.ptr(v)[u] = mean_of(sum.ptr<float>(v)[u], count.ptr<int>(v)[u]);
    }
  }
  return coarse;
}

MosaicRaster shrunk(const MosaicRaster& mosaic, double most_pixels) {
  const double side_m =
      fitting_resolution(mosaic.grey.size(), mosaic.metres_per_pixel, most_pixels);
  return binned(mosaic, side_m, frame_of(mosaic, side_m));
}

MosaicDifference difference_of(const MosaicRaster& a, const MosaicRaster& b, double most_pixels) {
  double side_m = std::max(a.metres_per_pixel, b.metres_per_pixel);
  const cv::Rect both = frame_of(a, side_m) | frame_of(b, side_m);
  side_m = fitting_resolution(both.size(), side_m, most_pixels);
  const cv::Rect frame = frame_of(a, side_m) | frame_of(b, side_m);
  const MosaicRaster first = binned(a, side_m, frame);
  const MosaicRaster second = binned(b, side_m, frame);
  MosaicDifference difference{{{}, side_m, first.top_left_m}, cv::Mat(frame.size(), CV_8UC3)};
  std::size_t common = 0;
  std::size_t differing = 0;
  for (int v = 0; v < frame.height; ++v) {
    for (int u = 0; u < frame.width; ++u) {
      const unsigned char in_a = first.grey.ptr(v)[u];
      const unsigned char in_b = second.grey.ptr(v)[u];
      difference.picture.ptr<cv::Vec3b>(v)[u] = colour_of(in_a, in_b);
      if (in_a == kUnseen || in_b == kUnseen) continue;
      ++common;
      if (std::abs(in_a - in_b) > kDiffers) ++differing;
    }
  }
  difference.common_m2 = static_cast<double>(common) * side_m * side_m;
  if (common > 0) {
    difference.share_differs = static_cast<double>(differing) / static_cast<double>(common);
  }
  return difference;
}

}  // namespace fathom
