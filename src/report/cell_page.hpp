#pragma once

#include <nlohmann/json.hpp>

#include "chart_rows.hpp"
#include "example_page.hpp"

namespace fathom {

/// Of one cell of the results: its estimators, paired tests and example, but the regime map and the
/// verdict (docs/report.md lists the keys).
nlohmann::ordered_json cell_json(const ChartInput& input, std::size_t place,
                                 const ExampleLimits& limits);

}  // namespace fathom
