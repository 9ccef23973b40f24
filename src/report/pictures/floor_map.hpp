#pragma once

#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/vision/camera.hpp"

namespace fathom {

/// Where the pixels of a picture of the floor lie: x up and y to the left.
struct FloorMap {
  Eigen::Vector2d top_left;  ///< corner of the first pixel: greatest x, greatest y; metres
  double metres_per_pixel = 1.0;
  cv::Size size;

  /// (column, row), centres at whole numbers.
  Eigen::Vector2d pixel(const Eigen::Vector2d& point) const {
    return {(top_left.y() - point.y()) / metres_per_pixel - 0.5,
            (top_left.x() - point.x()) / metres_per_pixel - 0.5};
  }
  /// The middle of a pixel.
  Eigen::Vector2d point(int column, int row) const {
    return {top_left.x() - (row + 0.5) * metres_per_pixel,
            top_left.y() - (column + 0.5) * metres_per_pixel};
  }
};

/// The border of what a picture covers, in the body frame. Distortion bends it, so that the four
/// corners alone would not do. Throws InputError on an altitude that is not positive.
std::vector<Eigen::Vector2d> seen_outline(const Camera& camera, const Stance& stance);

/// The pixels whose middle is within a polygon of world points: 255 there, 0 elsewhere. Only the
/// part `box` of the map is looked at, and the mask is of its size.
cv::Mat mask_of(const FloorMap& map, const std::vector<Eigen::Vector2d>& polygon,
                const cv::Rect& box);

}  // namespace fathom
