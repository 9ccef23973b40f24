#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "example_trial.hpp"

namespace fathom {

/// To about so many of each estimator its lists are thinned.
struct ExampleLimits {
  std::size_t keyframes = 0;
  std::size_t loops = 0;
  std::size_t absolute = 0;
};

/// The trial that the page draws (docs/report.md lists the keys).
nlohmann::ordered_json example_json(const ExampleTrial& example, const CellResults& cell,
                                    const ExampleLimits& limits);

/// What became of a measurement, in words by its name.
nlohmann::ordered_json fates_json();

}  // namespace fathom
