#pragma once

#include <cmath>

#include "src/datasets/simulated/floor_renderer.hpp"

namespace fathom::test {

/// 12 by 12 m of even grey.
inline World grey_world(int grey) {
  return {cv::Mat(600, 600, CV_8UC1, cv::Scalar(grey)), 0.02, {}};
}

inline FloorRenderer renderer_of(const World& world, const CameraModel& model = {}) {
  const Camera camera(model);
  return {camera, ViewRays(camera), world};
}

/// A bright dot, smooth so that its centroid is where it was put, on 6 by 6 m of dark floor.
inline World dot_world(const Eigen::Vector2d& dot) {
  World world{cv::Mat(1501, 1501, CV_8UC1, cv::Scalar(20)), 0.004, {}};
  const Eigen::Vector2d at = world.pixel(dot);
  for (int v = 0; v < world.picture.rows; ++v) {
    for (int u = 0; u < world.picture.cols; ++u) {
      const double r2 = (Eigen::Vector2d(u, v) - at).squaredNorm();
      if (r2 < 900)
        world.picture.at<uchar>(v, u) = cv::saturate_cast<uchar>(20 + 200 * std::exp(-r2 / 50));
    }
  }
  return world;
}

/// Pixel (u, v) of what is brighter than the floor around it.
inline Eigen::Vector2d dot_in(const cv::Mat& picture) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      const double grey = std::max(0, picture.at<uchar>(v, u) - 24);
      sum += grey * Eigen::Vector2d(u, v);
      weight += grey;
    }
  }
  return sum / weight;
}

}  // namespace fathom::test
