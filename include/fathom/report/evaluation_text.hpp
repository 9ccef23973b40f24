#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "fathom/evaluation/spatial_accuracy.hpp"

namespace fathom {

/// What stands over the figures of an evaluation.
struct EvaluationHead {
  std::string alignment;
  std::size_t estimate_size = 0;  ///< poses of the estimate, with and without a partner
  bool is_paired_by_index = false;
  /// Of every pose with a partner its index in the estimate, rising.
  std::vector<std::size_t> paired = {};
};

/// What relative errors are over.
struct RelativeLengths {
  std::vector<std::size_t> steps;
  std::vector<double> distances_m;
};

/// All figures, as `fathom evaluate` prints them: lines, each with its end. Throws InputError where
/// a relative error does.
std::string evaluation_text(const SpatialAccuracy& judged, const EvaluationHead& head,
                            const RelativeLengths& lengths);

}  // namespace fathom
