#include "fathom/report/palette.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <utility>

namespace fathom {

Colour series_colour(std::string_view name) {
  static constexpr std::array<std::pair<std::string_view, Colour>, 5> kKnown{{
      {"ground truth", palette::black},
      {"dead reckoning", palette::grey},
      {"trajectory_iekf", palette::blue},
      {"ekf", palette::vermillion},
      {"ceres_pose_graph", palette::green},
  }};
  for (const auto& [known, colour] : kKnown) {
    if (known == name) return colour;
  }
  static constexpr std::array<Colour, 3> kOthers{palette::purple, palette::orange,
                                                 palette::sky_blue};
  std::uint32_t hash = 2166136261U;  // FNV-1a: the same on every machine, unlike std::hash
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 16777619U;
  return kOthers[hash % kOthers.size()];
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
