#pragma once

#include <string>

#include "bag_messages.hpp"

namespace fathom {

/// A picture of a bag as a file's content.
struct BagPicture {
  std::string extension;  ///< ".png" or ".jpg"
  std::string bytes;
  int width = 0;
  int height = 0;
};

/// Grey and colour of 8 and of 16 bits become PNG without loss, an alpha channel is left out, a
/// Bayer mosaic and YUV become colour. Throws InputError on another encoding or a size that the
/// data does not have.
BagPicture picture_of(const ImageMessage& message);

/// The JPEG or PNG as it is, but for a grey one that is a Bayer mosaic by its format, which becomes
/// colour. Throws InputError where it is another format or cannot be decoded.
BagPicture picture_of(const CompressedImageMessage& message);

}  // namespace fathom
