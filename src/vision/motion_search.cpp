#include "motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <utility>

#include "pair_ransac.hpp"
#include "rigid_motion.hpp"

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
  ShiftGrid(double error_m, double reach_m, const DecisionTuning& tuning)
      : error_m_(error_m),
        reach_m_(reach_m),
        spacing_m_(tuning.grid_spacing * error_m),
        steps_(tuning.grid_steps),
        cells_(static_cast<std::size_t>(side()) * static_cast<std::size_t>(side())) {}

  // The grid is no finer than the error, so that no other points than the four about it are near.
  void add(int index, const Eigen::Vector2d& apart_m) {
    const Eigen::Vector2d at = apart_m / spacing_m_;
    if (!(at.cwiseAbs().maxCoeff() < steps_ + 1.0)) return;
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
  int side() const { return 2 * steps_ + 1; }

  void add_to(int row, int column, int index, const Eigen::Vector2d& apart_m) {
    if (std::max(std::abs(row), std::abs(column)) > steps_) return;
    const Eigen::Vector2d shift = spacing_m_ * Eigen::Vector2d(row, column);
    if (shift.norm() < reach_m_ || (apart_m - shift).norm() > error_m_) return;
    const int down = row + steps_;
    const int along = column + steps_;
    cells_[static_cast<std::size_t>(down) * static_cast<std::size_t>(side()) +
           static_cast<std::size_t>(along)]
        .push_back(index);
  }

  double error_m_;
  double reach_m_;
  double spacing_m_;
  int steps_;  // to either side
  std::vector<std::vector<int>> cells_;
};

// Nearer to another than this a motion lives on its support.
double rival_distance_m(const RegistrationOptions& options) {
  return options.tuning.decision.rival_distance * *options.ransac.max_error_m;
}

}  // namespace

Hypothesis find_hypothesis(const MatchSet& putative, const MatchSet& nearest,
                           const RegistrationOptions& options, std::uint64_t seed) {
  const DecisionTuning& tuning = options.tuning.decision;
  const double max_error_m = *options.ransac.max_error_m;
  RansacOptions any = options.ransac;
  any.min_inliers = 2;
  any.min_places = 1;
  any.score = RansacScore::inliers;
  Hypothesis found;
  found.motion = ransac(putative.pairs(), any, seed, options.tuning.ransac).motion;
  if (!found.motion) return found;
  found.support = nearest.pairs().inliers(*found.motion, max_error_m);
  for (int round = 0; round < tuning.support_rounds; ++round) {
    const std::optional<Pose> again = fit(nearest.pairs(), found.support);
    if (!again) break;
    std::vector<int> support = nearest.pairs().inliers(*again, max_error_m);
    if (support.size() < found.support.size()) break;
    const bool settled = support == found.support;
    found.motion = again;
    found.support = std::move(support);
    if (settled) break;
  }
  found.places = nearest.pairs().count_places(found.support, max_error_m, tuning.most_places);
  return found;
}

Hypothesis find_rival(const Hypothesis& best, const MatchSet& putative, const MatchSet& nearest,
                      const RegistrationOptions& options, std::uint64_t seed) {
  const double reach_m = rival_distance_m(options);
  return find_hypothesis(putative.without(putative.pairs().inliers(*best.motion, reach_m)),
                         nearest.without(nearest.pairs().inliers(*best.motion, reach_m)), options,
                         seed);
}

int most_places_elsewhere(const Pose& best, const MatchSet& nearest, double error_m,
                          const RegistrationOptions& options) {
  const PointPairs pairs = nearest.pairs().turning(best.theta);
  ShiftGrid grid(error_m, rival_distance_m(options), options.tuning.decision);
  for (std::size_t j = 0; j < pairs.size(); ++j) {
    const int index = static_cast<int>(j);
    grid.add(index, pairs.p(index) - transform(best, pairs.q(index)));
  }
  int most = 0;
  for (const std::vector<int>& inliers : grid.by_falling_size()) {
    if (static_cast<int>(inliers.size()) <= most) break;
    most =
        std::max(most, pairs.count_places(inliers, error_m, options.tuning.decision.most_places));
  }
  return most;
}

}  // namespace fathom
