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
  int places = 0;              ///< in which these lie
};

/// The motion that most matches agree on, by RANSAC (the paper's figure 2) over the putative ones,
/// refitted to its inliers among all nearest matches until they no longer change.
Hypothesis find_hypothesis(const MatchSet& putative, const MatchSet& nearest,
                           const RegistrationOptions& options, std::uint64_t seed);

/// The motion with the second most support, found likewise among the matches that do not agree
/// with the best one, not even nearly.
Hypothesis find_rival(const Hypothesis& best, const MatchSet& putative, const MatchSet& nearest,
                      const RegistrationOptions& options, std::uint64_t seed);

/// The most places of nearest pairs that a motion with the heading of `best` brings together within
/// `error_m`, over a grid of translations about it that spares those within `rival_distance`. On a
/// floor that repeats itself it is large: the motion that is a ripple further has many.
int most_places_elsewhere(const Pose& best, const MatchSet& nearest, double error_m,
                          const RegistrationOptions& options);

}  // namespace fathom
