#pragma once

#include <opencv2/core.hpp>

#include "vision/textured_floor.hpp"

namespace fathom::test {

/// A picture of 500 × 500 pixels, to find keypoints in.
inline const cv::Mat& picture() {
  static const cv::Mat texture = TexturedFloor(500, 0.005, 11).picture();
  return texture;
}

}  // namespace fathom::test
