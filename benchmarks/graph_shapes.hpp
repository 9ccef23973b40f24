#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom::benchmarks {

/// Pose graphs of the shapes that surveys and drives have, with the noise of their sensors. The
/// same seed gives the same graph. None of them is a recorded one: constants are chosen on these,
/// and judged on those.

/// A drive of one lap of streets, 1 m between keyframes, of which the last three tenths are driven
/// again: `loops` keyframes of them, evenly spread, see that of the first time.
MeasurementLog drive(std::size_t keyframes, std::size_t loops, std::uint64_t seed);

/// A robot in the corridors of an office, 0.5 m between keyframes; precise scans register each
/// keyframe with up to two others, older and at most 1.5 m away.
MeasurementLog office(std::size_t keyframes, std::uint64_t seed);

/// Streets as of city_streets, in which each keyframe sees up to six older ones at most 8 m away.
MeasurementLog dense_streets(std::size_t keyframes, std::uint64_t seed);

/// Laps of one oval of a hundred keyframes: each sees that of the lap before.
MeasurementLog circuit(std::size_t keyframes, std::uint64_t seed);

}  // namespace fathom::benchmarks
