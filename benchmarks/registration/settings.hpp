#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fathom/vision/registration.hpp"
#include "support/pairs/pairs.hpp"

namespace fathom::benchmarks {

/// What the command line asks for.
struct Settings {
  std::vector<std::string> floors{"ripples", "mud", "pebbles", "patches"};
  std::vector<std::string> worlds;      ///< FILE:METRES_PER_PIXEL each
  std::vector<std::string> conditions;  ///< empty: all
  std::vector<int> buckets;             ///< tenths of overlap, 0 to 9; empty: all
  std::size_t pairs_per_cell = 5;
  std::size_t negatives = 200;  ///< per floor
  std::size_t pool = 40;        ///< pictures per floor that they are made of
  std::uint64_t seed = 1;
  std::size_t jobs = 2;
  bool opencv = true;
  bool speed = false;
  bool plain = false;            ///< decide as the paper does, by a count of inliers
  std::vector<std::string> set;  ///< KEY=VALUE of the registration's options, to sweep them
  std::string json;              ///< file; empty: none
};

/// The one place where a registration is told of its condition, such as how steady a camera is.
/// Throws InputError where `set` has a key or a value that cannot be.
RegistrationOptions registration_options_for(const test::Condition& condition,
                                             const Settings& settings);

/// From where on an accepted motion counts as wrong: 5 pixels of the lower of the two pictures and
/// 0.02 rad, and what the condition itself makes of a planar pose besides: in translation four
/// standard deviations of two tilted cameras and the height of a relief, in heading a standard
/// deviation of the tilt and the relief's share of the altitude.
struct WrongLimits {
  double translation_m = 0.0;
  double heading_rad = 0.0;
};
WrongLimits wrong_limits(const test::Condition& condition, double metres_per_pixel);

}  // namespace fathom::benchmarks
