#include "fathom/front_end/rendered_pictures.hpp"

#include <cstring>
#include <string_view>

#include "fathom/core/hash.hpp"

namespace fathom {
namespace {

// What is rendered under a number is told by picture_id alone.
RegistrationKey key_of(std::uint64_t picture_id) {
  const auto hash = [picture_id](int word) {
    return Hash(word).add("rendered picture").add(picture_id).value();
  };
  return {hash(1), hash(2)};
}

}  // namespace

cv::Mat RenderedPictures::image(std::size_t i) const {
  const RegistrationKey key = key_of(source_.picture_id(i));
  const CameraModel& model = source_.camera().model();
  if (const auto bytes = cache_.find(key)) {
    cv::Mat kept(model.height, model.width, CV_8U);
    if (bytes->size() == kept.total()) {
      std::memcpy(kept.data, bytes->data(), bytes->size());
      return kept;
    }
  }
  cv::Mat made = source_.image(i);
  const cv::Mat whole = made.isContinuous() ? made : made.clone();
  cache_.put(key, std::string_view(reinterpret_cast<const char*>(whole.data), whole.total()));
  return made;
}

}  // namespace fathom
