#pragma once

#include <cstddef>
#include <cstdint>

#include "fathom/front_end/pair_registrar.hpp"
#include "front_end/floor_survey.hpp"

namespace fathom::test {

/// The seed of registrations where another would do.
inline constexpr std::uint64_t kSeed = 5;

/// A frame of a FloorSurvey, taken from where it is or, as measured, from another altitude.
inline MeasuredFrame at(std::size_t frame, double altitude_m = kAltitudeM) {
  return {frame, altitude_m};
}

}  // namespace fathom::test
