#pragma once

#include <functional>

#include <opencv2/core.hpp>

#include "canvas.hpp"

namespace fathom {

/// An 8-bit BGR picture with marks drawn over it. A point is a pixel, and whole numbers are the
/// centres of pixels.
cv::Mat drawn_over(const cv::Mat& bgr, const std::function<void(Canvas&)>& draw);

}  // namespace fathom
