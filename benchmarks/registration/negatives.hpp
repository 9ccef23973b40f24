#pragma once

#include "floors.hpp"

namespace fathom::benchmarks {

/// Pairs of one floor that do not overlap, and how many were accepted all the same.
struct Negatives {
  std::string floor;
  std::size_t pairs = 0;
  std::size_t ours = 0;
  std::size_t opencv = 0;
  double least_false_alarms = 1.0;  ///< of all pairs, the least chance of the best motion's support
};

/// A pool of pictures in clear water, features extracted once; `negatives` of its pairs whose
/// footprints lie apart, drawn without replacement, or all where there are fewer. On ripples half
/// of the pool has one heading, so that crests lie alike. Pairs share pictures, so they are not
/// quite independent.
Negatives run_negatives(const Floor& floor, const Settings& settings);

}  // namespace fathom::benchmarks
