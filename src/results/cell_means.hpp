#pragma once

#include <vector>

#include "fathom/evaluation/clustered.hpp"
#include "fathom/results/selection.hpp"

namespace fathom {

/// The mean over cells of the cells' means, each cell with one value or more. Cells are given
/// conditions and no sample of any, so its interval resamples within each: of several surveys the
/// surveys, common to all cells, and the trials within them (`interval_over_cells`); of a single
/// survey the trials (a stratified BCa bootstrap; of a single cell `bootstrap_interval`). None
/// where a cell has one value, or one survey where another has more.
TrialMean mean_over_cells(const std::vector<ClusteredValues>& cells);

/// The end of the interval on a requirement's wrong side, or the value where there is no interval.
double decisive_end(const Requirement& requirement, const TrialMean& value);

}  // namespace fathom
