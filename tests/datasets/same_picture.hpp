#pragma once

#include <opencv2/core.hpp>

namespace fathom::test {

/// Of one size and type, and the same in every pixel.
inline bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

}  // namespace fathom::test
