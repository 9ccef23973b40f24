#pragma once

#include <string>

#include "fathom/vision/registration.hpp"
#include "motion_search.hpp"

namespace fathom {

/// What speaks for the motion with the most support and against it. The count is taken twice, at
/// `max_error_m` and at a part of it (a third), where chance brings together its square less; the
/// one that is less likely by chance counts.
Evidence weigh(const SupportedMotion& best, const SupportedMotion& rival, const MatchSet& nearest,
               const RegistrationOptions& options);

/// Why a motion with this evidence is not found; empty: it is.
std::string objection(const Evidence& evidence, const RegistrationOptions& options);

}  // namespace fathom
