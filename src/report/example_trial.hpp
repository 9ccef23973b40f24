#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "study_results.hpp"

namespace fathom {

/// To about so many of each estimator its lists are thinned.
struct ExampleLimits {
  std::size_t keyframes = 0;
  std::size_t loops = 0;
  std::size_t absolute = 0;
};

/// The lowest trial of a cell's lowest survey, drawn: `survey`, `trial`, `text` (both in words),
/// `truth` (null where unknown) and per estimator its path, 2σ ellipses, loops and absolute
/// measurements.
nlohmann::ordered_json example_trial(const ResultStore& store, const CellResults& cell,
                                     const ExampleLimits& limits);

}  // namespace fathom
