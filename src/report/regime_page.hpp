#pragma once

#include <nlohmann/json.hpp>

#include "study_results.hpp"

namespace fathom {

/// What the page's regime maps show, of a study with two axes: into the page and its cells.
void add_regimes(const StudyResults& results, nlohmann::ordered_json& page);

}  // namespace fathom
