#include "fathom/core/environment_error.hpp"
#include "fathom/core/module.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "picture_codecs.hpp"

namespace fathom {
namespace {

const PictureCodecs& load_codecs() {
  const LoadedModule module =
      load_module({FATHOM_MODULE_BUILT, FATHOM_MODULE_INSTALLED}, kPictureCodecs);
  if (module.symbol == nullptr) {
    throw EnvironmentError("pictures are neither read nor written: " + module.problem +
                           "; if it is missing or damaged, or lacks a library, 'scripts/build.sh' "
                           "or the package fathom puts it right");
  }
  return *static_cast<const PictureCodecs*>(module.symbol);
}

const PictureCodecs& codecs() {
  static const PictureCodecs& loaded = load_codecs();
  return loaded;
}

}  // namespace

cv::Mat decode_picture(std::string_view bytes, int flags) {
  return codecs().decode(bytes, flags);
}

std::string encode_picture(const std::string& ending, const cv::Mat& picture,
                           const std::vector<int>& parameters) {
  return codecs().encode(ending, picture, parameters);
}

}  // namespace fathom
