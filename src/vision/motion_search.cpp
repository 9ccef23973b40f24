#include "motion_search.hpp"

#include <limits>

#include "fathom/vision/rigid_motion.hpp"
#include "pair_ransac.hpp"

namespace fathom {
namespace {

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
  found.places = nearest.pairs().count_places(found.supporters, options.max_error_m,
                                              std::numeric_limits<int>::max());
  return found;
}

int most_places_elsewhere(const SupportedMotion& best, const MatchSet& nearest, double reach_m,
                          double error_m) {
  const PointPairs& pairs = nearest.pairs();
  const PointPairs turning = pairs.turning(best.motion->theta);
  int most = 0;
  std::vector<int> most_of;
  constexpr int kShifts = 16;
  for (int column = -kShifts; column <= kShifts; ++column) {
    for (int row = -kShifts; row <= kShifts; ++row) {
      const Eigen::Vector2d shift = 1.5 * error_m * Eigen::Vector2d(column, row);
      if (shift.norm() < reach_m) continue;
      const Pose z{best.motion->x + shift.x(), best.motion->y + shift.y(), best.motion->theta};
      const int count = turning.count_agreeing(z, error_m);
      if (count <= most) continue;
      const int places = turning.count_places(turning.agreeing(z, error_m), error_m, 1000);
      most = std::max(most, places);
    }
  }
  return most;
}

SupportedMotion find_rival(const SupportedMotion& best, const MatchSet& distinct,
                           const MatchSet& nearest, const RansacOptions& options,
                           std::uint64_t seed) {
  // Motions next to the best one live on its own supporters; three times its reach leaves none.
  const double reach_m = 3.0 * options.max_error_m;
  return find_supported_motion(distinct.without(distinct.pairs().agreeing(*best.motion, reach_m)),
                               nearest.without(nearest.pairs().agreeing(*best.motion, reach_m)),
                               options, seed);
}

}  // namespace fathom
