#pragma once

#include <cstddef>
#include <string>

#include "verdict.hpp"

namespace fathom {

/// "3 of 40 cells", "all 40 cells".
std::string of_cells(std::size_t count, std::size_t all);

/// Of several cells: in how many an estimator is worse or equivalent, and where there is no
/// verdict.
void add_answer(const StudyResults& results, StudyVerdict& verdict);

/// What so few draws do not exclude, of estimators that are called equivalent: a sentence.
std::string rare_text(std::size_t draws);

}  // namespace fathom
