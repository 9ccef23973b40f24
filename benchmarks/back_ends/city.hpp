#pragma once

#include <cstddef>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom::benchmarks {

/// A simulated drive through the streets of a city: a random walk on a square grid of crossings,
/// straight on, left or right with the same probability, three keyframes from one crossing to the
/// next and 5 m between keyframes. At a crossing it sees the keyframe that was there last. The city
/// has a crossing for every three that are passed. Always the same.
MeasurementLog city_streets(std::size_t keyframes);

}  // namespace fathom::benchmarks
