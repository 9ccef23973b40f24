#pragma once

#include <string>

#include "study_results.hpp"

namespace fathom {

/// Tables for \usepackage{booktabs}: one a cell, estimators by metrics; from seven cells on one a
/// metric, cells by estimators. Captions name alignment, association and n.
std::string latex_tables(const StudyResults& results);

}  // namespace fathom
