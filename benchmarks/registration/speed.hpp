#pragma once

#include "floors.hpp"

namespace fathom::benchmarks {

/// Median milliseconds of matching and solving a pair, one thread.
struct Speed {
  std::size_t from_features = 0;
  std::size_t to_features = 0;
  std::size_t repeats = 0;
  double ours_ms = 0.0;
  double opencv_ms = 0.0;
};

/// One pair in clear water that overlaps by half, over and over, the two in turns.
Speed measure_speed(const Floor& floor, const Settings& settings);

}  // namespace fathom::benchmarks
