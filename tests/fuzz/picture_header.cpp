// The first bytes of a picture, and a PNG without its damaged parts.
#include "src/datasets/picture_header.hpp"

#include "support/fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace fathom;
  const std::string_view bytes = fuzz::text_of(data, size);
  size_in_header(bytes);
  const std::optional<std::string> sound = sound_png(bytes);
  fuzz::require(!sound || sound_png(*sound) == sound, "what is sound stays as it is");
  return 0;
}
