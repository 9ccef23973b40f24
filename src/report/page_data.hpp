#pragma once

#include <nlohmann/json.hpp>

#include "chart_rows.hpp"

namespace fathom {

/// All that the page shows (docs/report.md lists the keys): over all trials the summaries and the
/// statistics by keyframe, and of one trial a cell, the lowest, its trajectories and loops. Numbers
/// have 6 digits.
nlohmann::ordered_json page_data(const ResultStore& store, const ChartInput& input);

}  // namespace fathom
