#include "blend.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace fathom {
namespace {

float bilinear(const cv::Mat& picture, double u, double v) {
  u = std::clamp(u, 0.0, picture.cols - 1.0);
  v = std::clamp(v, 0.0, picture.rows - 1.0);
  const int column = std::max(0, std::min(static_cast<int>(u), picture.cols - 2));
  const int row = std::max(0, std::min(static_cast<int>(v), picture.rows - 2));
  const int right = std::min(column + 1, picture.cols - 1);
  const auto fu = static_cast<float>(u - column);
  const auto fv = static_cast<float>(v - row);
  const float* top = picture.ptr<float>(row);
  const float* bottom = picture.ptr<float>(std::min(row + 1, picture.rows - 1));
  const float above = top[column] + fu * (top[right] - top[column]);
  const float below = bottom[column] + fu * (bottom[right] - bottom[column]);
  return above + fv * (below - above);
}

// 1 in the middle of the picture, 0 at its border.
float tent(double pixel, int count) {
  return static_cast<float>(1.0 - std::abs(2.0 * (pixel + 0.5) / count - 1.0));
}

std::vector<Eigen::Vector2d> outline_of(const Camera& camera, const PlacedPicture& place) {
  std::vector<Eigen::Vector2d> outline = seen_outline(camera, place.stance);
  for (Eigen::Vector2d& point : outline) point = transform(place.pose, point);
  return outline;
}

cv::Rect box_around(const FloorMap& map, const std::vector<Eigen::Vector2d>& outline) {
  Eigen::Vector2d low = map.pixel(outline.front());
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& point : outline) {
    low = low.cwiseMin(map.pixel(point));
    high = high.cwiseMax(map.pixel(point));
  }
  const cv::Point first(static_cast<int>(std::floor(low.x())),
                        static_cast<int>(std::floor(low.y())));
  const cv::Point last(static_cast<int>(std::ceil(high.x())),
                       static_cast<int>(std::ceil(high.y())));
  return cv::Rect(first, last + cv::Point(1, 1)) & cv::Rect({0, 0}, map.size);
}

/// A row of a picture's box as the picture is laid on it.
struct RowOfBox {
  const Camera& camera;
  const cv::Mat& source;  ///< the picture, perhaps reduced
  cv::Size full;          ///< the picture's own size
  Stance stance;
  Eigen::Vector2d first;  ///< of the box's first column, in the body frame
  Eigen::Vector2d step;   ///< from column to column
};

RowOfBox row_of_box(const Camera& camera, const cv::Mat& source, cv::Size full,
                    const PlacedPicture& place, const FloorMap& map, cv::Point first) {
  const Pose body_from_world = inverse(place.pose);
  const Eigen::Vector2d begin = transform(body_from_world, map.point(first.x, first.y));
  const Eigen::Vector2d next = transform(body_from_world, map.point(first.x + 1, first.y));
  return {camera, source, full, place.stance, begin, next - begin};
}

/// Adds a column of a row; `column` counts from the box's first.
void add_pixel(const RowOfBox& row, int column, float& sum, float& weight) {
  const Eigen::Vector2d pixel = row.camera.pixel(row.first + column * row.step, row.stance);
  // Never quite zero, so that a picture's border shows where it is alone.
  const float share = std::max(1e-3F, tent(pixel.x(), row.full.width)) *
                      std::max(1e-3F, tent(pixel.y(), row.full.height));
  const double scale_u = row.source.cols / static_cast<double>(row.full.width);
  const double scale_v = row.source.rows / static_cast<double>(row.full.height);
  sum += share *
         bilinear(row.source, scale_u * (pixel.x() + 0.5) - 0.5, scale_v * (pixel.y() + 0.5) - 0.5);
  weight += share;
}

}  // namespace

Blend::Blend(const Camera& camera, const MosaicPlan& plan, const cv::Rect& window)
    : camera_(camera),
      map_{plan.top_left_m, plan.metres_per_pixel, plan.size},
      window_(window),
      sum_(cv::Mat::zeros(window.size(), CV_32F)),
      weight_(cv::Mat::zeros(window.size(), CV_32F)) {}

cv::Rect Blend::box_of(const Camera& camera, const MosaicPlan& plan, const PlacedPicture& place) {
  return box_around({plan.top_left_m, plan.metres_per_pixel, plan.size}, outline_of(camera, place));
}

// Where the mosaic is coarser than the picture, its pixels are means and not samples.
cv::Mat Blend::reduced(const cv::Mat& picture, const Stance& stance) const {
  const auto corners = camera_.footprint(stance);
  const double width_px = (corners[1] - corners[0]).norm() / map_.metres_per_pixel;
  const double factor = std::floor(picture.cols / width_px);
  if (!(factor >= 2.0)) return picture;
  cv::Mat small;
  const cv::Size size(std::max(1, static_cast<int>(std::lround(picture.cols / factor))),
                      std::max(1, static_cast<int>(std::lround(picture.rows / factor))));
  cv::resize(picture, small, size, 0, 0, cv::INTER_AREA);
  return small;
}

void Blend::lay(const cv::Mat& picture, const PlacedPicture& place) {
  const std::vector<Eigen::Vector2d> outline = outline_of(camera_, place);
  const cv::Rect box = box_around(map_, outline);
  const cv::Rect part = box & window_;
  if (part.empty()) return;
  const cv::Mat mask = mask_of(map_, outline, box);
  const cv::Mat source = reduced(picture, place.stance);
  // Rows share nothing, so that the number of threads changes no sum.
  cv::parallel_for_({part.y, part.y + part.height}, [&](const cv::Range& rows) {
    for (int v = rows.start; v < rows.end; ++v) {
      const RowOfBox row =
          row_of_box(camera_, source, picture.size(), place, map_, cv::Point(box.x, v));
      const unsigned char* is_seen = mask.ptr(v - box.y);
      float* sum = sum_.ptr<float>(v - window_.y);
      float* weight = weight_.ptr<float>(v - window_.y);
      for (int u = part.x; u < part.x + part.width; ++u) {
        if (is_seen[u - box.x] == 0) continue;
        add_pixel(row, u - box.x, sum[u - window_.x], weight[u - window_.x]);
      }
    }
  });
}

cv::Mat Blend::finish() {
  cv::Mat mosaic(window_.size(), CV_8U, cv::Scalar(kUnseen));
  for (int row = 0; row < mosaic.rows; ++row) {
    const float* sum = sum_.ptr<float>(row);
    const float* weight = weight_.ptr<float>(row);
    unsigned char* grey = mosaic.ptr(row);
    for (int column = 0; column < mosaic.cols; ++column) {
      if (!(weight[column] > 0.0F)) continue;
      const float mean = std::round(sum[column] / weight[column]);
      grey[column] = static_cast<unsigned char>(std::clamp(mean, 0.0F, kUnseen - 1.0F));
    }
  }
  sum_.release();
  weight_.release();
  return mosaic;
}

}  // namespace fathom
