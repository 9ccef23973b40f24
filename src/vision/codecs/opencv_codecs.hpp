#pragma once

#include <limits>
#include <new>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/imgcodecs.hpp>

// What stands behind picture_codecs.hpp, in the library that links the codecs and in the module
// that is loaded. It throws std::bad_alloc alone.

namespace fathom::opencv_codecs {

template <class Result, class Action>
Result or_nothing(Action action) {
  try {
    return action();
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();
    return {};
  }
}

inline cv::Mat decode(std::string_view bytes, int flags) {
  if (bytes.empty() || bytes.size() > std::numeric_limits<int>::max()) return {};
  return or_nothing<cv::Mat>([&] {
    // OpenCV has no row of constant bytes; it does not change these.
    const cv::Mat row(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    return cv::imdecode(row, flags);
  });
}

/// Empty where there is no such format, or it cannot hold the picture.
inline std::string encode(const std::string& ending, const cv::Mat& picture,
                          const std::vector<int>& parameters) {
  return or_nothing<std::string>([&] {
    std::vector<uchar> bytes;
    if (!cv::imencode(ending, picture, bytes, parameters)) bytes.clear();
    return std::string(bytes.begin(), bytes.end());
  });
}

}  // namespace fathom::opencv_codecs
