#pragma once

#include <vector>

#include <opencv2/core.hpp>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/features.hpp"

namespace fathom::test {

inline constexpr double kMetresPerPixel = 0.004;

/// Between two pictures of such points.
inline const Pose kTrueMotion{0.3, -0.2, 0.7};

/// Points with descriptors of their own, so that row i of one such picture matches row i of another
/// one and no other. They have neither sizes nor orientations.
inline FloorFeatures labelled(const std::vector<Eigen::Vector2d>& points) {
  FloorFeatures picture;
  picture.points = points;
  for (const Eigen::Vector2d& point : points) {
    picture.features.pixels.push_back(point / kMetresPerPixel);
  }
  const int rows = static_cast<int>(points.size());
  picture.features.descriptors = cv::Mat::eye(rows, rows, CV_32F) * 200.0;
  picture.viewpoint = {{0.0, 0.0}, 2.0, kMetresPerPixel};
  return picture;
}

}  // namespace fathom::test
