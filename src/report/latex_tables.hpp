#pragma once

#include <string>
#include <string_view>

#include "study_results.hpp"

namespace fathom {

/// Text as LaTeX prints it: its ten special characters escaped, Greek letters and superscripts of
/// our own labels as mathematics, line ends as blanks.
std::string latex_text(std::string_view text);

/// Tables for \usepackage{booktabs}: one a cell, estimators by metrics; from seven cells on one a
/// metric, cells by estimators. Captions name alignment, association and n.
std::string latex_tables(const StudyResults& results);

}  // namespace fathom
