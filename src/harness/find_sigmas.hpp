#pragma once

#include <vector>

#include "fathom/front_end/estimated_sigmas.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom {

/// What the loops of a recording say of the standard deviations that are to be estimated
/// (docs/variance_components.md); nothing where none is. `measured` are the frames it is of.
/// Intervals cost as much as the rest. Without, they are still found where the values would not be
/// `are_assumed_too_small`; else `low` is NaN.
std::vector<FoundSigma> find_sigmas(const Recording& recording, const FrameSource& measured,
                                    const CovarianceOptions& options,
                                    const EstimatorRegistry& registry, bool with_intervals);

/// Whether a registration's own errors were found with assumed tilts that are too small, so that
/// they hold what larger tilts do to second order.
bool are_assumed_too_small(const EstimatedSigmas& sigmas, const CovarianceOptions& options);

/// Those that were found.
EstimatedSigmas sigmas_of(const std::vector<FoundSigma>& found);

}  // namespace fathom
