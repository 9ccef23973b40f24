#include "floor_lookup.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "floor_renderer.hpp"

namespace fathom {
namespace {

int floor_of(float value) {
  const int towards_zero = static_cast<int>(value);
  return towards_zero - (value < static_cast<float>(towards_zero) ? 1 : 0);
}

// The coarsest level that has at least two pixels to one of the view.
std::size_t level_for(double floor_pixels_per_pixel, std::size_t levels) {
  const double level = std::floor(std::log2(floor_pixels_per_pixel)) - 1.0;
  return static_cast<std::size_t>(std::clamp(level, 0.0, static_cast<double>(levels - 1)));
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

FloorLookup::FloorLookup(const std::vector<cv::Mat>& levels, const Eigen::Vector2d& base,
                         const Eigen::Matrix2d& A, double floor_pixels_per_pixel) {
  const std::size_t index = level_for(floor_pixels_per_pixel, levels.size());
  level_ = levels[index];
  const double scale = std::ldexp(1.0, -static_cast<int>(index));
  const Eigen::Vector2d level_base = scale * (base.array() + 0.5) - 0.5;
  const Eigen::Vector2d origin = level_base.array().floor();
  base_ = (level_base - origin).cast<float>();
  A_ = (scale * A).cast<float>();
  first_ = (-origin).cast<float>();
  last_ = (Eigen::Vector2d(level_.cols - 1, level_.rows - 1) - origin).cast<float>();
  row_bytes_ = static_cast<std::ptrdiff_t>(level_.step);
  offset_ = static_cast<std::ptrdiff_t>(origin.y()) * row_bytes_ +
            static_cast<std::ptrdiff_t>(origin.x());
}

float FloorLookup::mean(const Corners& corners) const {
  Eigen::Vector2f least = corners[0];
  Eigen::Vector2f most = corners[0];
  for (const Eigen::Vector2f& corner : corners) {
    least = least.cwiseMin(corner);
    most = most.cwiseMax(corner);
  }
  // A whole pixel of room: the last one has none to its right, and rounding may step over.
  const bool is_inside = (least.array() >= first_.array() + 1.0F).all() &&
                         (most.array() <= last_.array() - 1.0F).all();
  return is_inside ? mean_of_samples<false>(corners) : mean_of_samples<true>(corners);
}

template <bool kNearBorder>
float FloorLookup::mean_of_samples(const Corners& corners) const {
  constexpr int kAcross = FloorRenderer::kSamplesAcross;
  constexpr float kStep = 1.0F / kAcross;
  float sum = 0.0F;
  for (int j = 0; j < kAcross; ++j) {
    const float down = kStep * (static_cast<float>(j) + 0.5F);
    const Eigen::Vector2f left = corners[0] + down * (corners[2] - corners[0]);
    const Eigen::Vector2f right = corners[1] + down * (corners[3] - corners[1]);
    const Eigen::Vector2f step = kStep * (right - left);
    for (int i = 0; i < kAcross; ++i) {
      sum += at<kNearBorder>(left + (static_cast<float>(i) + 0.5F) * step);
    }
  }
  return sum * (kStep * kStep);
}

// Bilinear.
template <bool kNearBorder>
float FloorLookup::at(Eigen::Vector2f place) const {
  if (kNearBorder) place = place.cwiseMax(first_).cwiseMin(last_);
  const int column = floor_of(place.x());
  const int row = floor_of(place.y());
  const float across = place.x() - static_cast<float>(column);
  const float down = place.y() - static_cast<float>(row);
  std::ptrdiff_t right = 1;
  std::ptrdiff_t below = row_bytes_;
  if (kNearBorder) {
    if (static_cast<float>(column) >= last_.x()) right = 0;
    if (static_cast<float>(row) >= last_.y()) below = 0;
  }
  const uchar* pixel = level_.data + (offset_ + row * row_bytes_ + column);
  const auto upper_left = static_cast<float>(pixel[0]);
  const auto lower_left = static_cast<float>(pixel[below]);
  const float upper = upper_left + across * (static_cast<float>(pixel[right]) - upper_left);
  const float lower = lower_left + across * (static_cast<float>(pixel[below + right]) - lower_left);
  return upper + down * (lower - upper);
}

}  // namespace fathom
