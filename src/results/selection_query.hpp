#pragma once

#include <string>
#include <vector>

#include "fathom/results/selection.hpp"

namespace fathom {

/// The cells that `AXIS=LABEL` restrictions leave, in order. Throws InputError on an axis or label
/// that the study has not, with the nearest.
std::vector<std::size_t> cells_where(const StudyDescription& study,
                                     const std::vector<std::string>& where);

/// Throws InputError on a metric that is not known, with the nearest.
void require_metrics(const SelectionQuery& query, const StudyDescription& study,
                     const std::vector<std::string>& known);

}  // namespace fathom
