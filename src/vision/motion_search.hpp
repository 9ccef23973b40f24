#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/ransac.hpp"
#include "match_set.hpp"

namespace fathom {

/// A motion, and how much speaks for it.
struct SupportedMotion {
  std::optional<Pose> motion;   ///< nothing: no two matches agree
  std::vector<int> supporters;  ///< rising indices of the nearest pairs that it brings together
  int places = 0;               ///< in which these lie
};

/// The motion that most matches agree on, by RANSAC over the distinct ones, settled on all nearest
/// pairs: fitted to those that it brings together until they no longer change.
SupportedMotion find_supported_motion(const MatchSet& distinct, const MatchSet& nearest,
                                      const RansacOptions& options, std::uint64_t seed);

/// The most places of nearest pairs that a motion with the heading of `best` brings together, at
/// `error_m`, among shifts of it to places all around, not near it.
int most_places_elsewhere(const SupportedMotion& best, const MatchSet& nearest, double reach_m,
                          double error_m);

/// The motion with the second most support: among the matches that do not agree with `best`, not
/// even nearly. On a floor that repeats itself it has much.
SupportedMotion find_rival(const SupportedMotion& best, const MatchSet& distinct,
                           const MatchSet& nearest, const RansacOptions& options,
                           std::uint64_t seed);

}  // namespace fathom
