#pragma once

#include <string>
#include <string_view>

namespace fathom {

struct Colour {
  unsigned char red = 0;
  unsigned char green = 0;
  unsigned char blue = 0;

  bool operator==(const Colour&) const = default;
};

/// The colours of Okabe and Ito (*Color Universal Design*, 2008), told apart with every common form
/// of colour blindness.
namespace palette {
inline constexpr Colour black{0x00, 0x00, 0x00};
inline constexpr Colour orange{0xE6, 0x9F, 0x00};
inline constexpr Colour sky_blue{0x56, 0xB4, 0xE9};
inline constexpr Colour green{0x00, 0x9E, 0x73};
inline constexpr Colour blue{0x00, 0x72, 0xB2};
inline constexpr Colour vermillion{0xD5, 0x5E, 0x00};
inline constexpr Colour purple{0xCC, 0x79, 0xA7};
inline constexpr Colour grey{0x8A, 0x8A, 0x8A};
inline constexpr Colour white{0xFF, 0xFF, 0xFF};
}  // namespace palette

/// The colour of a trajectory by its name, the same in every picture and page: one each for
/// "ground truth", "dead reckoning" and the estimators that come with Fathom; any other name has
/// one of three, by a hash of it.
Colour series_colour(std::string_view name);

/// `share` of the colour on white: 1 the colour itself, 0 white.
Colour tint(Colour colour, double share);

/// As a web page writes it: "#0072b2".
std::string hex(Colour colour);

}  // namespace fathom
