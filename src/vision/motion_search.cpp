#include "motion_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "fathom/vision/rigid_motion.hpp"
#include "pair_ransac.hpp"

namespace fathom {
namespace {

constexpr int kAll = std::numeric_limits<int>::max();

std::optional<Pose> fit(const PointPairs& pairs, const std::vector<int>& indices) {
  std::vector<Eigen::Vector2d> p;
  std::vector<Eigen::Vector2d> q;
  for (const int index : indices) {
    p.push_back(pairs.p(index));
    q.push_back(pairs.q(index));
  }
  return find_motion(p, q);
}

}  // namespace

SupportedMotion find_supported_motion(const MatchSet& distinct, const MatchSet& nearest,
                                      const RansacOptions& options, std::uint64_t seed) {
  RansacOptions any = options;
  any.min_inliers = 2;
  any.min_places = 1;
  any.score = RansacScore::inliers;
  SupportedMotion found;
  found.motion = ransac(distinct.pairs(), any, seed).motion;
  if (!found.motion) return found;
  found.supporters = nearest.pairs().agreeing(*found.motion, options.max_error_m);
  constexpr int kRounds = 10;
  for (int round = 0; round < kRounds; ++round) {
    const std::optional<Pose> again = fit(nearest.pairs(), found.supporters);
    if (!again) break;
    std::vector<int> supporters = nearest.pairs().agreeing(*again, options.max_error_m);
    if (supporters.size() < found.supporters.size()) break;
    const bool settled = supporters == found.supporters;
    found.motion = again;
    found.supporters = std::move(supporters);
    if (settled) break;
  }
  found.places = nearest.pairs().count_places(found.supporters, options.max_error_m, kAll);
  return found;
}

SupportedMotion find_rival(const SupportedMotion& best, const MatchSet& distinct,
                           const MatchSet& nearest, const RansacOptions& options,
                           std::uint64_t seed) {
  const double reach_m = kRivalReach * options.max_error_m;
  return find_supported_motion(distinct.without(distinct.pairs().agreeing(*best.motion, reach_m)),
                               nearest.without(nearest.pairs().agreeing(*best.motion, reach_m)),
                               options, seed);
}

int most_places_elsewhere(const Pose& best, const MatchSet& nearest, double reach_m,
                          double error_m) {
  // Discs of the error on a grid of one and a half leave few gaps, and nothing counts twice.
  constexpr double kSpacing = 1.5;
  constexpr int kSteps = 16;
  const PointPairs pairs = nearest.pairs().turning(best.theta);
  int most = 0;
  for (int row = -kSteps; row <= kSteps; ++row) {
    for (int column = -kSteps; column <= kSteps; ++column) {
      const Eigen::Vector2d shift = kSpacing * error_m * Eigen::Vector2d(row, column);
      if (shift.norm() < reach_m) continue;
      const Pose moved{best.x + shift.x(), best.y + shift.y(), best.theta};
      if (pairs.count_agreeing(moved, error_m) <= most) continue;
      most = std::max(most, pairs.count_places(pairs.agreeing(moved, error_m), error_m, kAll));
    }
  }
  return most;
}

}  // namespace fathom
