#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "study_results.hpp"

namespace fathom {

/// As RFC 4180 has it: in quotes where it holds a comma, a quote or the end of a line. What a
/// spreadsheet would run as a formula, a text that begins with =, +, -, @ or a tab, has an
/// apostrophe before it; numbers have none.
std::string csv_field(std::string_view text);

/// One line a run; a metric that a run lacks is an empty field.
std::string runs_csv(const StudyResults& results);

/// One line per cell, estimator and metric; n is 0 where no run that was done has the metric. Lines
/// of cost are over the runs of one kind of processor; those of the others follow.
std::string summary_csv(const StudyResults& results, const std::vector<StudyResults>& others = {});

}  // namespace fathom
