#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace fathom {

struct Colour {
  unsigned char red = 0;
  unsigned char green = 0;
  unsigned char blue = 0;

  bool operator==(const Colour&) const = default;
};

/// The colours of Okabe and Ito (*Color Universal Design*, 2008) without their yellow, which white
/// paper hides, and two more that are as far from them with every common form of colour blindness.
namespace palette {
inline constexpr Colour black{0x00, 0x00, 0x00};
inline constexpr Colour orange{0xE6, 0x9F, 0x00};
inline constexpr Colour sky_blue{0x56, 0xB4, 0xE9};
inline constexpr Colour green{0x00, 0x9E, 0x73};
inline constexpr Colour blue{0x00, 0x72, 0xB2};
inline constexpr Colour vermillion{0xD5, 0x5E, 0x00};
inline constexpr Colour purple{0xCC, 0x79, 0xA7};
inline constexpr Colour sienna{0xA0, 0x52, 0x2D};
inline constexpr Colour violet{0x64, 0x40, 0xE8};
/// Of no line: what an estimator left out.
inline constexpr Colour crimson{0xC4, 0x00, 0x3C};
inline constexpr Colour grey{0x8A, 0x8A, 0x8A};
inline constexpr Colour white{0xFF, 0xFF, 0xFF};
}  // namespace palette

/// The shape of a point in a chart.
enum class Mark { disc, square, diamond, triangle };

/// How the line of a trajectory or of an estimator's results is drawn, the same in every picture,
/// figure and page.
struct LineStyle {
  Colour colour;
  std::vector<double> dashes;  ///< lengths on and off in points (1/72 inch); empty: solid
  Mark mark = Mark::disc;      ///< of a result that is a point and no line

  bool operator==(const LineStyle&) const = default;
};

/// Estimators of a study beyond so many share colours.
inline constexpr std::size_t kEstimatorColours = 8;

/// By the place of an estimator in its study, from 0: eight colours, solid, with discs; then the
/// same colours in three patterns of dashes with other marks. What comes after these 32 repeats
/// them.
LineStyle estimator_style(std::size_t place);

LineStyle ground_truth_style();
LineStyle dead_reckoning_style();

/// `share` of the colour on white: 1 the colour itself, 0 white.
Colour tint(Colour colour, double share);

/// As a web page writes it: "#0072b2".
std::string hex(Colour colour);

}  // namespace fathom
