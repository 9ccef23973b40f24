#pragma once

#include <cstddef>
#include <string>

#include "fathom/measurements/graph_check.hpp"

namespace fathom {

/// Lines of one kind that are shown.
inline constexpr std::size_t kShown = 20;

/// Says how many lines are not shown, if any.
void print_rest(std::size_t count);

/// What is in a pose graph, as `fathom check` says it.
void print_graph(const GraphSummary& graph);

}  // namespace fathom
