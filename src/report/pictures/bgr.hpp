#pragma once

#include <opencv2/core.hpp>

namespace fathom {

/// The picture as 8-bit BGR; grey ones are copied to three channels. Throws InputError on a picture
/// that is empty or of another type than 8-bit with one or three channels.
cv::Mat as_bgr(const cv::Mat& picture);

}  // namespace fathom
