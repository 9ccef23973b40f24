#pragma once

#include <algorithm>

#include <opencv2/core.hpp>

namespace fathom {

/// Between the four pixels around (u, v), whose places are given.
inline float bilinear(const float* top, const float* bottom, int left, int right, float fu,
                      float fv) {
  const float above = top[left] + fu * (top[right] - top[left]);
  const float below = bottom[left] + fu * (bottom[right] - bottom[left]);
  return above + fv * (below - above);
}

/// Of a CV_32F picture anywhere: beyond the outermost pixels' middles as there.
inline float sample(const cv::Mat& picture, double u, double v) {
  u = std::clamp(u, 0.0, picture.cols - 1.0);
  v = std::clamp(v, 0.0, picture.rows - 1.0);
  const int column = std::max(0, std::min(static_cast<int>(u), picture.cols - 2));
  const int row = std::max(0, std::min(static_cast<int>(v), picture.rows - 2));
  return bilinear(picture.ptr<float>(row), picture.ptr<float>(std::min(row + 1, picture.rows - 1)),
                  column, std::min(column + 1, picture.cols - 1), static_cast<float>(u - column),
                  static_cast<float>(v - row));
}

}  // namespace fathom
