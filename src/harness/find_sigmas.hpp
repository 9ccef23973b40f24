#pragma once

#include <vector>

#include "fathom/front_end/estimated_sigmas.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom {

/// What the loops of a recording say of the standard deviations that are to be estimated
/// (docs/variance_components.md); nothing where none is. `measured` are the frames it is of.
std::vector<FoundSigma> find_sigmas(const Recording& recording, const FrameSource& measured,
                                    const CovarianceOptions& options,
                                    const EstimatorRegistry& registry);

/// Those that were found.
EstimatedSigmas sigmas_of(const std::vector<FoundSigma>& found);

}  // namespace fathom
