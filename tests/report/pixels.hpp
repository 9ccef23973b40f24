#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/report/palette.hpp"

namespace fathom::test {

/// Of a trajectory.png, below title and legend and above the labels of the axis.
inline cv::Mat map_of(const cv::Mat& picture) {
  return picture.rowRange(125, picture.rows - 120).clone();
}

/// Where a picture has exactly this colour.
inline cv::Mat where(const cv::Mat& picture, Colour colour) {
  const cv::Scalar bgr(colour.blue, colour.green, colour.red);
  cv::Mat mask;
  cv::inRange(picture, bgr, bgr, mask);
  return mask;
}

/// Where a picture has about this colour: what a thin smooth line of it leaves.
inline cv::Mat where_nearly(const cv::Mat& picture, Colour colour, int tolerance) {
  const cv::Scalar bgr(colour.blue, colour.green, colour.red);
  cv::Mat mask;
  cv::inRange(picture, bgr - cv::Scalar::all(tolerance), bgr + cv::Scalar::all(tolerance), mask);
  return mask;
}

inline int count(const cv::Mat& picture, Colour colour) {
  return cv::countNonZero(where(picture, colour));
}

/// Mean position (u, v) of a colour; NaN where it does not occur.
inline Eigen::Vector2d mean_position(const cv::Mat& picture, Colour colour) {
  const cv::Mat mask = where(picture, colour);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int v = 0; v < mask.rows; ++v) {
    for (int u = 0; u < mask.cols; ++u) {
      if (mask.at<unsigned char>(v, u) != 0) sum += Eigen::Vector2d(u, v);
    }
  }
  return sum / cv::countNonZero(mask);
}

inline bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

}  // namespace fathom::test
