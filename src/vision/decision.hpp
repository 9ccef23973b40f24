#pragma once

#include <string>

#include "fathom/vision/registration.hpp"
#include "motion_search.hpp"

namespace fathom {

/// The a-contrario test (Desolneux, Moisan, Morel, Int. J. Computer Vision 40, 2000; for RANSAC
/// Moisan and Stival 2004): how likely chance alone gives the best motion its support, when what
/// chance does is measured on the pair itself, by the strongest rival. The count is taken twice, of
/// the best motion and of its rivals, at `max_error_m` and at a part of it (a third), where chance
/// brings together its square less; the one that is less likely by chance counts.
Evidence weigh(const Hypothesis& best, const Rivals& rivals, const MatchSet& nearest,
               const RegistrationOptions& options);

/// Why a motion with this evidence is not found; empty: it is.
std::string reason_to_refuse(const Evidence& evidence, const RegistrationOptions& options);

}  // namespace fathom
