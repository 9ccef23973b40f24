#pragma once

#include <vector>

#include "fathom/results/selection.hpp"

namespace fathom {

/// The mean over cells of the cells' means, each cell with one value or more. Its interval
/// resamples the trials within each cell (a stratified BCa bootstrap), as the cells are given
/// conditions and no sample of any: of a single cell it is `bootstrap_interval`. None where a cell
/// has one value.
TrialMean mean_over_cells(const std::vector<std::vector<double>>& cells);

/// The end of the interval on a requirement's wrong side, or the value where there is no interval.
double decisive_end(const Requirement& requirement, const TrialMean& value);

}  // namespace fathom
