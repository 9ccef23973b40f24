#pragma once

#include <cstddef>
#include <string>

#include "fathom/measurements/graph_check.hpp"

namespace fathom {

/// Lines of one kind that are shown.
inline constexpr std::size_t kMostShown = 20;

/// What is in a pose graph, as `fathom check` prints it: lines, each with its end.
std::string graph_text(const GraphSummary& graph);

}  // namespace fathom
