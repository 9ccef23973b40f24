#pragma once

#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "chart_rows.hpp"

namespace fathom {

/// Text within HTML: its five special characters as entities.
std::string html_text(std::string_view text);

/// The whole report.html: it loads nothing, from nowhere. Its data is the JSON in #data; `mosaics`
/// that in #mosaics-data. A study without a title has that of its folder, `name`.
std::string report_page(const ResultStore& store, const ChartInput& input,
                        const nlohmann::ordered_json& mosaics, const std::string& name);

}  // namespace fathom
