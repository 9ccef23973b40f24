#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <opencv2/core.hpp>

namespace fathom {

/// Sea floors that can be drawn. All have texture from the grain to the metre, mud the least.
enum class FloorKind {
  mixed,    ///< ripples that wander, fork and fade, dark patches, stones; nothing repeats
  ripples,  ///< one train of constant wavelength and heading, so that places look alike; hard
  mud,      ///< smooth and faintly mottled, with burrows and few stones
  pebbles,  ///< densely strewn with pebbles
  patches   ///< sand with dark patches of algae and heaps of stones
};

/// The kinds by name, in the order above.
const std::vector<std::pair<std::string, FloorKind>>& floor_kinds();

/// A picture of a sea floor, 8-bit grey, lit from the upper left. The same arguments give the same
/// picture, whatever the number of threads. Both sizes in pixels, > 0.
cv::Mat draw_sea_floor(cv::Size size, double metres_per_pixel, std::uint64_t seed,
                       FloorKind kind = FloorKind::mixed);

}  // namespace fathom
