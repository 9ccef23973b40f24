#pragma once

#include <string>

#include <opencv2/core.hpp>

namespace fathom {

/// The bytes of a PNG file of an 8-bit picture of one or three channels (BGR, as OpenCV has it).
/// Throws InputError on a picture that is empty or of another type.
std::string encode_png(const cv::Mat& picture);

}  // namespace fathom
