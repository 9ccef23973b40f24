#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/registration.hpp"
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
                                      const RegistrationOptions& options, std::uint64_t seed);

/// The motion with the second most support, found likewise among the matches that do not agree
/// with the best one, not even nearly.
SupportedMotion find_rival(const SupportedMotion& best, const MatchSet& distinct,
                           const MatchSet& nearest, const RegistrationOptions& options,
                           std::uint64_t seed);

/// The most places of nearest pairs that a motion with the heading of `best` brings together within
/// `error_m`, over a grid of translations about it that spares those within `rival_distance`. On a
/// floor that repeats itself it is large: the motion that is a ripple further has many.
int most_places_elsewhere(const Pose& best, const MatchSet& nearest, double error_m,
                          const RegistrationOptions& options);

}  // namespace fathom
