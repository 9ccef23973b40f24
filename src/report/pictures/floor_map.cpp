#include "floor_map.hpp"

#include <cmath>

#include <opencv2/imgproc.hpp>

namespace fathom {

std::vector<Eigen::Vector2d> seen_outline(const Camera& camera, const Stance& stance) {
  return camera.outline(stance, camera.model().has_distortion() ? 24 : 1);
}

cv::Mat mask_of(const FloorMap& map, const std::vector<Eigen::Vector2d>& polygon,
                const cv::Rect& box) {
  constexpr int kShift = 8;
  std::vector<cv::Point> fixed;
  for (const Eigen::Vector2d& point : polygon) {
    const Eigen::Vector2d pixel = map.pixel(point) - Eigen::Vector2d(box.x, box.y);
    fixed.emplace_back(static_cast<int>(std::lround(pixel.x() * (1 << kShift))),
                       static_cast<int>(std::lround(pixel.y() * (1 << kShift))));
  }
  cv::Mat mask = cv::Mat::zeros(box.size(), CV_8U);
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{fixed}, cv::Scalar(255), cv::LINE_8,
               kShift);
  return mask;
}

}  // namespace fathom
