#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fathom {

/// Rows and columns as a file's header tells them: what decoding it would ask memory for.
struct HeaderSize {
  std::uint64_t width = 0;
  std::uint64_t height = 0;
};

/// Of a PNG, JPEG, BMP, TIFF or Netpbm file. Nothing of other formats (WebP has at most 2^28 pixels
/// by itself), or where the header does not tell.
std::optional<HeaderSize> size_in_header(std::string_view bytes);

/// A PNG file without what its checksums show to be damaged and a decoder would warn of and pass
/// over. Nothing where a part that the picture needs is damaged or missing, or its header asks for
/// what no PNG is.
std::optional<std::string> sound_png(std::string_view bytes);

}  // namespace fathom
