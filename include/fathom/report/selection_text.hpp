#pragma once

#include <string>

#include "fathom/configuration/study_description.hpp"
#include "fathom/results/selection.hpp"

namespace fathom {

/// What `fathom select` prints of a selection, in lines that end in '\n' (docs/select.md): who is
/// chosen, or why nobody is and who is nearest; the lead over the second best; a table with a row
/// per estimator and requirement, each in its worst cell; a table of the objective, dead reckoning
/// last; the remarks. Values are in the units of their metrics, with four significant digits.
/// `query` and `study` are those that the selection was made from.
std::string selection_text(const Selection& selection, const SelectionQuery& query,
                           const StudyDescription& study);

}  // namespace fathom
