#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

// OpenCV's codecs of picture files. In the program they are loaded with the first picture: they
// draw in some hundred libraries, and of those who start it most read none.

namespace fathom {

/// The picture of a file's bytes, as cv::imdecode gives it; empty where they are none.
/// Throws EnvironmentError where the codecs cannot be loaded.
cv::Mat decode_picture(std::string_view bytes, int flags = cv::IMREAD_UNCHANGED);

/// A file's bytes, in the format that the ending names, such as ".png"; empty where that cannot
/// hold the picture. The parameters are those of cv::imencode. Throws EnvironmentError where the
/// codecs cannot be loaded.
std::string encode_picture(const std::string& ending, const cv::Mat& picture,
                           const std::vector<int>& parameters = {});

}  // namespace fathom
