// Of libraries that link the codecs, and of the module that is loaded.
#include <limits>
#include <new>

#include "fathom/vision/picture_codecs.hpp"

namespace fathom {
namespace {

template <class Result, class Action>
Result or_nothing(Action action) {
  try {
    return action();
  } catch (const cv::Exception& error) {
    if (error.code == cv::Error::StsNoMem) throw std::bad_alloc();
    return {};
  }
}

}  // namespace

cv::Mat decode_picture(std::string_view bytes, int flags) {
  if (bytes.empty() || bytes.size() > std::numeric_limits<int>::max()) return {};
  return or_nothing<cv::Mat>([&] {
    // OpenCV has no row of constant bytes; it does not change these.
    const cv::Mat row(1, static_cast<int>(bytes.size()), CV_8U, const_cast<char*>(bytes.data()));
    return cv::imdecode(row, flags);
  });
}

std::string encode_picture(const std::string& ending, const cv::Mat& picture,
                           const std::vector<int>& parameters) {
  return or_nothing<std::string>([&] {
    std::vector<uchar> bytes;
    if (!cv::imencode(ending, picture, bytes, parameters)) bytes.clear();
    return std::string(bytes.begin(), bytes.end());
  });
}

}  // namespace fathom
