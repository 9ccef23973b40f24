#pragma once

#include <string>

#include "fathom/vision/registration.hpp"
#include "motion_search.hpp"

namespace fathom {

/// What speaks for the motion with the most support and against it. The count is taken twice, at
/// `max_error_m` and at a third of it, where chance brings together a ninth; the one that is less
/// likely by chance counts.
Evidence weigh(const SupportedMotion& best, const SupportedMotion& rival, const MatchSet& nearest,
               double max_error_m);

/// Why a motion with this evidence is not found; empty: it is.
std::string objection(const Evidence& evidence, const RansacOptions& ransac,
                      const DecisionOptions& decision);

}  // namespace fathom
