#include "floor_lookup.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

namespace fathom {
namespace {

float bilinear(const cv::Mat& picture, float u, float v) {
  u = std::clamp(u, 0.0F, static_cast<float>(picture.cols - 1));
  v = std::clamp(v, 0.0F, static_cast<float>(picture.rows - 1));
  const int column = std::min(static_cast<int>(u), std::max(picture.cols - 2, 0));
  const int row = std::min(static_cast<int>(v), std::max(picture.rows - 2, 0));
  const int right = std::min(column + 1, picture.cols - 1);
  const float fu = u - static_cast<float>(column);
  const float fv = v - static_cast<float>(row);
  const uchar* top = picture.ptr(row);
  const uchar* bottom = picture.ptr(std::min(row + 1, picture.rows - 1));
  const float above =
      static_cast<float>(top[column]) * (1 - fu) + static_cast<float>(top[right]) * fu;
  const float below =
      static_cast<float>(bottom[column]) * (1 - fu) + static_cast<float>(bottom[right]) * fu;
  return above * (1 - fv) + below * fv;
}

}  // namespace

std::vector<cv::Mat> area_pyramid(const cv::Mat& picture) {
  std::vector<cv::Mat> levels{picture};
  while (std::min(levels.back().rows, levels.back().cols) >= 4) {
    const cv::Mat& last = levels.back();
    const cv::Size half{last.cols / 2, last.rows / 2};
    // An odd last row or column is left out: any other ratio than two would shift the rest.
    cv::Mat next;
    cv::resize(last(cv::Rect(0, 0, 2 * half.width, 2 * half.height)), next, half, 0, 0,
               cv::INTER_AREA);
    levels.push_back(next);
  }
  return levels;
}

FloorLookup::FloorLookup(const std::vector<cv::Mat>& levels, double world_pixels_per_pixel) {
  const double level =
      std::clamp(std::log2(world_pixels_per_pixel), 0.0, static_cast<double>(levels.size() - 1));
  const int fine = static_cast<int>(level);
  const std::size_t index = static_cast<std::size_t>(fine);
  fine_ = levels[index];
  coarse_ = levels[std::min(index + 1, levels.size() - 1)];
  scale_ = std::ldexp(1.0F, -fine);
  coarse_share_ = static_cast<float>(level - fine);
}

float FloorLookup::at(const Eigen::Vector2f& pixel) const {
  const Eigen::Vector2f from_edge = scale_ * (pixel.array() + 0.5F);
  const float fine = bilinear(fine_, from_edge.x() - 0.5F, from_edge.y() - 0.5F);
  if (coarse_share_ == 0.0F) return fine;
  const float coarse = bilinear(coarse_, 0.5F * from_edge.x() - 0.5F, 0.5F * from_edge.y() - 0.5F);
  return fine + coarse_share_ * (coarse - fine);
}

}  // namespace fathom
