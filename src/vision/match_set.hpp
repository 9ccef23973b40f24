#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fathom/vision/features.hpp"
#include "fathom/vision/matching.hpp"
#include "fathom/vision/registration_tuning.hpp"
#include "point_pairs.hpp"

namespace fathom {

/// Matches of two pictures with what they say on the floor.
class MatchSet {
 public:
  /// With sizes, their sizes and orientations bear witness too; the paper's procedure has none.
  enum class Use { sizes, points_alone };

  /// Of matches that join the same two places the nearest in descriptors stays: SIFT puts several
  /// keypoints with different orientations at one place, which is the same evidence again. Those of
  /// keypoints of unlike size on the floor go: the altitudes say how large a thing is.
  MatchSet(std::vector<Match> matches, const FloorFeatures& from, const FloorFeatures& to, Use use,
           const MatchingTuning& tuning);

  std::size_t size() const { return matches_.size(); }
  /// By rising row of `from`.
  const std::vector<Match>& matches() const { return matches_; }
  const PointPairs& pairs() const { return pairs_; }

  /// Variance of the error of a match relative to that of others: the place of a keypoint is the
  /// less certain the larger it is. All 1 without sizes.
  double relative_variance(int index) const;

  /// Of `indices` (rising) those that remain when every feature takes part once, with its nearest:
  /// a feature that several others are nearest to is one piece of evidence.
  std::vector<int> one_to_one(const std::vector<int>& indices) const;

  /// Those not in `indices` (rising).
  MatchSet without(const std::vector<int>& indices) const;

 private:
  explicit MatchSet(double turn_tolerance_rad)
      : turn_tolerance_rad_(turn_tolerance_rad), pairs_({}, {}) {}

  double turn_tolerance_rad_;
  std::vector<Match> matches_;
  std::vector<double> turns_rad_;
  std::vector<double> relative_variances_;
  std::vector<Eigen::Vector2d> p_, q_;
  PointPairs pairs_;
};

}  // namespace fathom
