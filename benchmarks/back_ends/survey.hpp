#pragma once

#include <cstddef>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom::benchmarks {

/// A simulated survey of parallel tracks, there and back, as many as keyframes on each, 1 m between
/// keyframes and 2 m between tracks. `loops` keyframes, spread over all tracks but the first, see
/// the one beside them on the track before. Always the same.
MeasurementLog parallel_tracks(std::size_t keyframes, std::size_t loops);

}  // namespace fathom::benchmarks
