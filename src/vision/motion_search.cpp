#include "motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

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

// Translations on a grid about a motion, each with the pairs that it brings within the error: those
// that the motion leaves apart by so much. Discs of the error, one and a half of it from one to the
// next, leave few gaps and share little.
class ShiftGrid {
 public:
  ShiftGrid(double error_m, double reach_m)
      : error_m_(error_m), reach_m_(reach_m), cells_(std::size_t{kSide} * kSide) {}

  void add(int index, const Eigen::Vector2d& apart_m) {
    const Eigen::Vector2d at = apart_m / (kSpacing * error_m_);
    if (!(at.cwiseAbs().maxCoeff() < kSteps + 1.0)) return;
    const int row = static_cast<int>(std::floor(at.x()));
    const int column = static_cast<int>(std::floor(at.y()));
    for (const int r : {row, row + 1}) {
      for (const int c : {column, column + 1}) add_to(r, c, index, apart_m);
    }
  }

  std::vector<std::vector<int>> by_falling_size() {
    std::ranges::stable_sort(cells_, std::ranges::greater{}, &std::vector<int>::size);
    return std::move(cells_);
  }

 private:
  static constexpr double kSpacing = 1.5;
  static constexpr int kSteps = 16;  // to either side
  static constexpr int kSide = 2 * kSteps + 1;

  void add_to(int row, int column, int index, const Eigen::Vector2d& apart_m) {
    if (std::max(std::abs(row), std::abs(column)) > kSteps) return;
    const Eigen::Vector2d shift = kSpacing * error_m_ * Eigen::Vector2d(row, column);
    if (shift.norm() < reach_m_ || (apart_m - shift).norm() > error_m_) return;
    cells_[static_cast<std::size_t>((row + kSteps) * kSide + column + kSteps)].push_back(index);
  }

  double error_m_;
  double reach_m_;
  std::vector<std::vector<int>> cells_;
};

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
  found.places = nearest.pairs().count_places(found.supporters, options.max_error_m, kEnoughPlaces);
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
  const PointPairs pairs = nearest.pairs().turning(best.theta);
  ShiftGrid grid(error_m, reach_m);
  for (std::size_t j = 0; j < pairs.size(); ++j) {
    const int index = static_cast<int>(j);
    grid.add(index, pairs.p(index) - transform(best, pairs.q(index)));
  }
  int most = 0;
  for (const std::vector<int>& agreeing : grid.by_falling_size()) {
    if (static_cast<int>(agreeing.size()) <= most) break;
    most = std::max(most, pairs.count_places(agreeing, error_m, kEnoughPlaces));
  }
  return most;
}

}  // namespace fathom
