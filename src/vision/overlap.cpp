#include <algorithm>
#include <vector>

#include <opencv2/imgproc.hpp>

#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

std::vector<cv::Point2f> polygon(const Camera& camera, double altitude_m, const Pose& pose) {
  std::vector<cv::Point2f> corners;
  for (const Eigen::Vector2d& corner : camera.footprint(altitude_m)) {
    const Eigen::Vector2f point = transform(pose, corner).cast<float>();
    corners.emplace_back(point.x(), point.y());
  }
  return corners;
}

}  // namespace

double footprint_overlap(const Camera& camera, double altitude_a_m, double altitude_b_m,
                         const Pose& motion) {
  const auto a = polygon(camera, altitude_a_m, {});
  const auto b = polygon(camera, altitude_b_m, motion);
  std::vector<cv::Point2f> common;
  const double shared = cv::intersectConvexConvex(a, b, common);
  return shared / std::min(cv::contourArea(a), cv::contourArea(b));
}

}  // namespace fathom
