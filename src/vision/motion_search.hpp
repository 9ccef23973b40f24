#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/registration.hpp"
#include "match_set.hpp"

namespace fathom {

/// A motion with its support set: the matches that are its inliers.
struct Hypothesis {
  std::optional<Pose> motion;  ///< nothing: no two matches agree
  std::vector<int> support;    ///< rising indices of the nearest matches that are its inliers
};

/// The motion that most matches agree on, by RANSAC (the paper's figure 2) over the putative ones,
/// refitted to its inliers among all nearest matches until they no longer change.
Hypothesis find_hypothesis(const MatchSet& putative, const MatchSet& nearest,
                           const RegistrationOptions& options, std::uint64_t seed);

/// Other motions than the best one, and the matches that bear witness for them: those of the
/// nearest that do not agree with the best one, not even nearly.
struct Rivals {
  MatchSet matches;
  std::vector<Pose> motions;
};

/// The two strongest, each fitted to its matches: one found as the best motion was, and of those
/// with the heading of the best and another translation, however far, the one with the most places.
/// On a floor that repeats itself the latter are many: the motion that is a ripple further.
Rivals find_rivals(const Hypothesis& best, const MatchSet& putative, const MatchSet& nearest,
                   const RegistrationOptions& options, std::uint64_t seed);

}  // namespace fathom
