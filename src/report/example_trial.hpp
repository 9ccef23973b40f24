#pragma once

#include <cstddef>

#include <nlohmann/json.hpp>

#include "study_results.hpp"

namespace fathom {

/// The lowest trial of a cell's lowest survey, drawn: `survey`, `trial`, `text` (both in words),
/// `truth` (null where unknown) and per estimator its path, 2σ ellipses and loops, with the path
/// thinned to about `most_keyframes` and the loops to about `most_loops`.
nlohmann::ordered_json example_trial(const ResultStore& store, const CellResults& cell,
                                     std::size_t most_keyframes, std::size_t most_loops);

}  // namespace fathom
