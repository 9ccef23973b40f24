#pragma once

#include <chrono>
#include <optional>

#include "fathom/vision/registration.hpp"

namespace fathom::benchmarks {

/// Milliseconds of wall time since it was made.
class Stopwatch {
 public:
  double milliseconds() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - start_).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// What a contender says of one pair, and what it took.
struct Answer {
  std::optional<Pose> motion;  ///< of `to` in `from`; nothing: refused
  std::optional<Eigen::Matrix3d> covariance;
  double false_alarms = 1.0;  ///< ours: Evidence::false_alarms
  double match_ms = 0.0;
  double solve_ms = 0.0;
};

/// register_pair. With `split_time` matching is done once more, apart, so that its time can be
/// taken off; else all of it counts as solving.
Answer ours(const FloorFeatures& from, const FloorFeatures& to, const RegistrationOptions& options,
            std::uint64_t seed, bool split_time);

/// OpenCV's way on the same features: BFMatcher with the two nearest and the ratio of `options`,
/// then estimateAffinePartial2D (RANSAC at its defaults: 2000 trials, confidence 0.99, 10
/// refinements) on the points of the floor in units of `metres_per_pixel`, its threshold
/// max_error_m in these. Altitudes are in the points already, so the scale should be one; it is
/// ignored. Accepted with min_inliers inliers.
Answer opencv(const FloorFeatures& from, const FloorFeatures& to,
              const RegistrationOptions& options, double metres_per_pixel);

}  // namespace fathom::benchmarks
