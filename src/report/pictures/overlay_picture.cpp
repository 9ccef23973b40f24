#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <string>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "bgr.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/report/match_picture.hpp"
#include "fathom/report/palette.hpp"
#include "picture_canvas.hpp"

namespace fathom {
namespace {

constexpr double kLongestPx = 1500.0;
constexpr double kMapMarginPx = 30.0;
constexpr double kTextPx = 34.0;
/// Shares of grey (blue, green, red) that the two pictures give; together they make white.
const cv::Vec3d kInkA(0.0, 0.5, 1.0);
const cv::Vec3d kInkB(1.0, 0.5, 0.0);

using Corners = std::array<Eigen::Vector2d, 4>;

/// Floor metres in the body frame of A to pixels: x up, y to the left.
struct OverlayMap {
  Eigen::Vector2d top_left;  ///< greatest x, greatest y
  double pixels_per_metre = 1.0;
  cv::Size size;

  Eigen::Vector2d pixel(const Eigen::Vector2d& point) const {
    return {(top_left.y() - point.y()) * pixels_per_metre - 0.5,
            (top_left.x() - point.x()) * pixels_per_metre - 0.5};
  }
  Eigen::Vector2d point(int column, int row) const {
    return {top_left.x() - (row + 0.5) / pixels_per_metre,
            top_left.y() - (column + 0.5) / pixels_per_metre};
  }
};

OverlayMap map_of(const Corners& a, const Corners& b, double metres_per_pixel) {
  Eigen::Vector2d low = a[0];
  Eigen::Vector2d high = a[0];
  for (const Corners& corners : {a, b}) {
    for (const Eigen::Vector2d& corner : corners) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  const Eigen::Vector2d extent = high - low;
  OverlayMap map;
  map.top_left = high;
  map.pixels_per_metre = std::min(1.0 / metres_per_pixel, kLongestPx / extent.maxCoeff());
  constexpr double kLeastShare = 0.02;
  if (!(map.pixels_per_metre * metres_per_pixel > kLeastShare)) {
    throw InputError("the motion puts the two pictures too far apart to draw both");
  }
  const auto pixels = [&](double metres) {
    return std::max(1, static_cast<int>(std::ceil(metres * map.pixels_per_metre)));
  };
  map.size = cv::Size(pixels(extent.y()), pixels(extent.x()));
  return map;
}

// Distortion folds over outside the picture: a floor point that does not come back is not seen.
bool is_seen(const Camera& camera, double altitude_m, const Eigen::Vector2d& floor,
             const Eigen::Vector2d& pixel) {
  const CameraModel& model = camera.model();
  if (!(pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() <= model.width - 0.5 &&
        pixel.y() <= model.height - 0.5)) {
    return false;
  }
  if (!model.has_distortion()) return true;
  return (camera.floor_point(pixel, altitude_m) - floor).norm() < 1e-3 * altitude_m;
}

/// The picture on the map as grey values, and where it has any. `pose` is its body's in A's.
struct Laid {
  cv::Mat grey;
  cv::Mat mask;
};

Laid lay(const FloorPicture& picture, const Pose& pose, const OverlayMap& map) {
  cv::Mat columns(map.size, CV_32F);
  cv::Mat rows(map.size, CV_32F);
  Laid laid;
  laid.mask = cv::Mat::zeros(map.size, CV_8U);
  const Pose body_from_map = inverse(pose);
  for (int row = 0; row < map.size.height; ++row) {
    for (int column = 0; column < map.size.width; ++column) {
      const Eigen::Vector2d floor = transform(body_from_map, map.point(column, row));
      const Eigen::Vector2d pixel = picture.camera.pixel(floor, picture.altitude_m);
      const bool seen = is_seen(picture.camera, picture.altitude_m, floor, pixel);
      columns.at<float>(row, column) = seen ? static_cast<float>(pixel.x()) : 0.0F;
      rows.at<float>(row, column) = seen ? static_cast<float>(pixel.y()) : 0.0F;
      laid.mask.at<unsigned char>(row, column) = seen ? 255 : 0;
    }
  }
  cv::Mat grey;
  cv::cvtColor(as_bgr(picture.image), grey, cv::COLOR_BGR2GRAY);
  cv::remap(grey, laid.grey, columns, rows, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return laid;
}

cv::Mat blended(const Laid& a, const Laid& b) {
  cv::Mat picture(a.grey.size(), CV_8UC3, cv::Scalar::all(255));
  for (int row = 0; row < picture.rows; ++row) {
    for (int column = 0; column < picture.cols; ++column) {
      const bool in_a = a.mask.at<unsigned char>(row, column) != 0;
      const bool in_b = b.mask.at<unsigned char>(row, column) != 0;
      if (!in_a && !in_b) continue;
      // Where only one is, the other gives the same grey lightened, so that the tint stays pale.
      const double grey_a = a.grey.at<unsigned char>(row, column);
      const double grey_b = b.grey.at<unsigned char>(row, column);
      const cv::Vec3d ink =
          (in_a ? grey_a : 0.6 * grey_b) * kInkA + (in_b ? grey_b : 0.6 * grey_a) * kInkB;
      picture.at<cv::Vec3b>(row, column) = ink;
    }
  }
  return picture;
}

// Underwater pictures are dark: one gain for both, so that what agrees stays grey.
void brighten(Laid& a, Laid& b) {
  const double mean = 0.5 * (cv::mean(a.grey, a.mask)[0] + cv::mean(b.grey, b.mask)[0]);
  constexpr double kMean = 140.0;
  const double gain = std::clamp(kMean / std::max(mean, 1.0), 1.0, 3.0);
  a.grey *= gain;
  b.grey *= gain;
}

void check(const FloorPicture& picture, const std::string& name) {
  const CameraModel& model = picture.camera.model();
  const cv::Size size = as_bgr(picture.image).size();
  if (size == cv::Size(model.width, model.height)) return;
  throw InputError(fmt::format("picture {} has {} x {} pixels, its camera {} x {}", name,
                               size.width, size.height, model.width, model.height));
}

void draw_outline(Canvas& canvas, const OverlayMap& map, const Corners& corners, Colour colour) {
  std::vector<Eigen::Vector2d> polygon;
  for (const Eigen::Vector2d& corner : corners) {
    polygon.push_back(map.pixel(corner) + Eigen::Vector2d(kMapMarginPx, kMapMarginPx + kTextPx));
  }
  canvas.outline(polygon, {colour, 2.0, {}, 1.0});
}

}  // namespace

cv::Mat render_overlay(const FloorPicture& a, const FloorPicture& b, const Pose& motion_a_b) {
  check(a, "A");
  check(b, "B");
  if (!is_finite(motion_a_b)) throw InputError("the motion between the pictures must be finite");
  const Corners corners_a = a.camera.footprint(a.altitude_m);
  Corners corners_b = b.camera.footprint(b.altitude_m);
  for (Eigen::Vector2d& corner : corners_b) corner = transform(motion_a_b, corner);
  const OverlayMap map = map_of(corners_a, corners_b, a.altitude_m / a.camera.model().fx);
  Laid laid_a = lay(a, {}, map);
  Laid laid_b = lay(b, motion_a_b, map);
  brighten(laid_a, laid_b);
  const cv::Mat picture = blended(laid_a, laid_b);

  cv::Mat page;
  constexpr int kMargin = static_cast<int>(kMapMarginPx);
  cv::copyMakeBorder(picture, page, kMargin + static_cast<int>(kTextPx), kMargin, kMargin, kMargin,
                     cv::BORDER_CONSTANT, cv::Scalar::all(255));
  return drawn_over(page, [&](Canvas& canvas) {
    draw_outline(canvas, map, corners_a, palette::orange);
    draw_outline(canvas, map, corners_b, palette::blue);
    canvas.text("A orange, B blue, grey where they agree", {kMapMarginPx, kMapMarginPx + 12},
                {.size = 22.0});
  });
}

}  // namespace fathom
