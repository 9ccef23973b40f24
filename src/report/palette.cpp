#include "fathom/report/palette.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace fathom {

LineStyle estimator_style(std::size_t place) {
  static constexpr std::array<Colour, kEstimatorColours> kColours{
      palette::blue,   palette::vermillion, palette::green,  palette::purple,
      palette::orange, palette::sky_blue,   palette::sienna, palette::violet};
  static const std::array<std::vector<double>, 4> kPatterns{
      {{}, {4.0, 2.0}, {7.0, 2.0, 1.5, 2.0}, {9.0, 3.0}}};
  static constexpr std::array kMarks{Mark::disc, Mark::square, Mark::diamond, Mark::triangle};
  const std::size_t round = place / kColours.size() % kPatterns.size();
  return {kColours[place % kColours.size()], kPatterns[round], kMarks[round]};
}

LineStyle ground_truth_style() {
  return {palette::black, {}};
}

LineStyle dead_reckoning_style() {
  return {palette::grey, {4.0, 2.5}};
}

Colour tint(Colour colour, double share) {
  const auto mixed = [share](unsigned char channel) {
    return static_cast<unsigned char>(std::lround(255.0 - share * (255.0 - channel)));
  };
  return {mixed(colour.red), mixed(colour.green), mixed(colour.blue)};
}

std::string hex(Colour colour) {
  char buffer[8];
  std::snprintf(buffer, sizeof buffer, "#%02x%02x%02x", colour.red, colour.green, colour.blue);
  return buffer;
}

}  // namespace fathom
