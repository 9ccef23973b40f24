#pragma once

#include <string>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// What failed, stopped early or is missing of a cell's runs: sentences.
std::vector<std::string> failures_of(const CellResults& cell, const StudyDescription& study);

/// The same over all cells, with the number of those where it happened.
std::vector<std::string> failures_of(const StudyResults& results);

/// Names cells without runs: nothing else that is said of the study is of them.
void add_empty_cells(const StudyResults& results, std::vector<std::string>& sentences);

}  // namespace fathom
