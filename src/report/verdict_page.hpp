#pragma once

#include <nlohmann/json.hpp>

#include "verdict.hpp"

namespace fathom {

/// Adds `verdict` to the page's data, and to each of its `cells` a `verdict` and `rankings`.
void add_verdict(const StudyResults& results, nlohmann::ordered_json& page);

}  // namespace fathom
