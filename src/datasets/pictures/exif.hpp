#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

namespace fathom {

/// What a camera wrote into a picture.
struct Exif {
  std::optional<std::int64_t> time_ns;  ///< DateTimeOriginal, taken for UTC
  std::optional<double> focal_35mm_mm;  ///< the focal length on a frame 36 mm wide
};

/// Nothing in a picture without EXIF, or where Fathom was built without libexif.
Exif read_exif(const std::filesystem::path& picture);

}  // namespace fathom
