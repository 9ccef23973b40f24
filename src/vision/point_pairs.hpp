#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Matched points p (seen in `from`) and q (seen in `to`), held as a structure of arrays so that a
/// motion is tested against all of them in one vectorised loop.
class PointPairs {
 public:
  /// Throws InputError where the two counts differ.
  PointPairs(std::span<const Eigen::Vector2d> p, std::span<const Eigen::Vector2d> q);

  /// With what each pair says of the heading of `to` in `from`, radians: the difference of the
  /// orientations of its keypoints. A motion further from it than `turn_tolerance_rad` does not
  /// agree.
  PointPairs(std::span<const Eigen::Vector2d> p, std::span<const Eigen::Vector2d> q,
             std::span<const double> turns_rad, double turn_tolerance_rad);

  std::size_t size() const { return px_.size(); }
  Eigen::Vector2d p(int index) const;
  Eigen::Vector2d q(int index) const;

  /// Whether two pairs may both agree with one motion: it keeps distances, so that theirs in the
  /// two pictures differ by 2 max_error_m at most.
  bool fit_together(int a, int b, double max_error_m) const;

  /// Those that may turn by `theta`, and no longer know their turn.
  PointPairs turning(double theta_rad) const;

  /// The inliers of a motion, ‖p − z ⊕ q‖ ≤ max_error_m: how many, and which, rising.
  int count_inliers(const Pose& z, double max_error_m) const;
  std::vector<int> inliers(const Pose& z, double max_error_m) const;

  /// In how many places the pairs lie, counted up to `enough`: greedily, in their order, a pair is
  /// a new place if both its p and its q are further than `radius_m` from those of all places so
  /// far.
  int count_places(const std::vector<int>& indices, double radius_m,
                   int enough = std::numeric_limits<int>::max()) const;

 private:
  std::vector<double> px_, py_, qx_, qy_;
  std::vector<double> turn_cosine_, turn_sine_;  // empty: unknown
  double least_turn_cosine_ = -1.0;              // of a turn within the tolerance
};

}  // namespace fathom
