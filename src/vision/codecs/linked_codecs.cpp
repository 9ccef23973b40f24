// Of programs that link the installed libraries, and of Python's: they have no place where a module
// would be.
#include "fathom/vision/picture_codecs.hpp"
#include "opencv_codecs.hpp"

namespace fathom {

cv::Mat decode_picture(std::string_view bytes, int flags) {
  return opencv_codecs::decode(bytes, flags);
}

std::string encode_picture(const std::string& ending, const cv::Mat& picture,
                           const std::vector<int>& parameters) {
  return opencv_codecs::encode(ending, picture, parameters);
}

}  // namespace fathom
