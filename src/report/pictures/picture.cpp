#include "fathom/report/picture.hpp"

#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "bgr.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/vision/picture_codecs.hpp"

namespace fathom {
namespace {

void require_usable(const cv::Mat& picture) {
  if (picture.empty()) throw InputError("the picture is empty");
  if (picture.type() != CV_8UC1 && picture.type() != CV_8UC3) {
    throw InputError(fmt::format(
        "a picture must have 8 bits and one or three channels, got {} bits and {} channels",
        8 * picture.elemSize1(), picture.channels()));
  }
}

}  // namespace

cv::Mat as_bgr(const cv::Mat& picture) {
  require_usable(picture);
  if (picture.channels() == 3) return picture;
  cv::Mat bgr;
  cv::cvtColor(picture, bgr, cv::COLOR_GRAY2BGR);
  return bgr;
}

std::string encode_png(const cv::Mat& picture) {
  require_usable(picture);
  std::string bytes = encode_picture(".png", picture);
  if (bytes.empty()) {
    throw InputError(fmt::format("a picture of {} x {} pixels cannot be encoded as PNG",
                                 picture.cols, picture.rows));
  }
  return bytes;
}

}  // namespace fathom
