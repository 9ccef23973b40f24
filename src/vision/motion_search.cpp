#include "motion_search.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <tuple>
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
// next, leave few gaps and share little. It has no end: a lattice may repeat after any distance.
class ShiftGrid {
 public:
  struct Cell {
    Eigen::Vector2d shift_m;
    std::vector<int> pairs;
  };

  ShiftGrid(double error_m, double reach_m, const DecisionTuning& tuning)
      : error_m_(error_m), reach_m_(reach_m), spacing_m_(tuning.grid_spacing * error_m) {}

  // The grid is no finer than the error, so that no other points than the four about it are near.
  void add(int index, const Eigen::Vector2d& apart_m) {
    constexpr double kMost = 1e15;  // that an integer holds
    const Eigen::Vector2d at = apart_m / spacing_m_;
    if (!(at.cwiseAbs().maxCoeff() < kMost)) return;
    const auto row = static_cast<std::int64_t>(std::floor(at.x()));
    const auto column = static_cast<std::int64_t>(std::floor(at.y()));
    for (const std::int64_t r : {row, row + 1}) {
      for (const std::int64_t c : {column, column + 1}) {
        const Eigen::Vector2d shift_m = shift(r, c);
        if (shift_m.norm() < reach_m_ || (apart_m - shift_m).norm() > error_m_) continue;
        near_.push_back({r, c, index});
      }
    }
  }

  std::vector<Cell> by_falling_size() {
    std::ranges::sort(
        near_, {}, [](const Near& near) { return std::tuple(near.row, near.column, near.pair); });
    std::vector<Cell> cells;
    for (std::size_t i = 0; i < near_.size(); ++i) {
      const Near& near = near_[i];
      if (i == 0 || near.row != near_[i - 1].row || near.column != near_[i - 1].column) {
        cells.push_back({shift(near.row, near.column), {}});
      }
      cells.back().pairs.push_back(near.pair);
    }
    std::ranges::stable_sort(cells, std::ranges::greater{},
                             [](const Cell& cell) { return cell.pairs.size(); });
    return cells;
  }

 private:
  struct Near {
    std::int64_t row;
    std::int64_t column;
    int pair;
  };

  Eigen::Vector2d shift(std::int64_t row, std::int64_t column) const {
    return spacing_m_ * Eigen::Vector2d(static_cast<double>(row), static_cast<double>(column));
  }

  double error_m_;
  double reach_m_;
  double spacing_m_;
  std::vector<Near> near_;
};

// Nearer to another than this a motion lives on its support.
double rival_distance_m(const RegistrationOptions& options) {
  return options.tuning.decision.rival_distance * *options.ransac.max_error_m;
}

// A motion fitted to its inliers until they no longer change, nor become fewer.
Hypothesis settled(const Pose& start, const MatchSet& nearest, const RegistrationOptions& options) {
  const DecisionTuning& tuning = options.tuning.decision;
  const double max_error_m = *options.ransac.max_error_m;
  Hypothesis found;
  found.motion = start;
  found.support = nearest.pairs().inliers(start, max_error_m);
  for (int round = 0; round < tuning.support_rounds; ++round) {
    const std::optional<Pose> again = fit(nearest.pairs(), found.support);
    if (!again) break;
    std::vector<int> support = nearest.pairs().inliers(*again, max_error_m);
    if (support.size() < found.support.size()) break;
    const bool is_same = support == found.support;
    found.motion = again;
    found.support = std::move(support);
    if (is_same) break;
  }
  return found;
}

// The motion with the heading of `best` and another translation that has the most places.
std::optional<Pose> strongest_shift(const Pose& best, const MatchSet& apart,
                                    const RegistrationOptions& options) {
  const double error_m = *options.ransac.max_error_m;
  const PointPairs pairs = apart.pairs().turning(best.theta);
  ShiftGrid grid(error_m, rival_distance_m(options), options.tuning.decision);
  for (std::size_t j = 0; j < pairs.size(); ++j) {
    const int index = static_cast<int>(j);
    grid.add(index, pairs.p(index) - transform(best, pairs.q(index)));
  }
  std::optional<Pose> strongest;
  int most = 0;
  for (const ShiftGrid::Cell& cell : grid.by_falling_size()) {
    if (static_cast<int>(cell.pairs.size()) <= most) break;
    const int places = pairs.count_places(cell.pairs, error_m);
    if (places <= most) continue;
    most = places;
    strongest = Pose{best.x + cell.shift_m.x(), best.y + cell.shift_m.y(), best.theta};
  }
  return strongest;
}

}  // namespace

Hypothesis find_hypothesis(const MatchSet& putative, const MatchSet& nearest,
                           const RegistrationOptions& options, std::uint64_t seed) {
  RansacOptions any = options.ransac;
  any.min_inliers = 2;
  any.min_places = 1;
  any.score = RansacScore::inliers;
  const std::optional<Pose> motion =
      ransac(putative.pairs(), any, seed, options.tuning.ransac).motion;
  return motion ? settled(*motion, nearest, options) : Hypothesis{};
}

Rivals find_rivals(const Hypothesis& best, const MatchSet& putative, const MatchSet& nearest,
                   const RegistrationOptions& options, std::uint64_t seed) {
  const double reach_m = rival_distance_m(options);
  Rivals rivals{nearest.without(nearest.pairs().inliers(*best.motion, reach_m)), {}};
  const Hypothesis second =
      find_hypothesis(putative.without(putative.pairs().inliers(*best.motion, reach_m)),
                      rivals.matches, options, seed);
  if (second.motion) rivals.motions.push_back(*second.motion);
  const std::optional<Pose> shifted = strongest_shift(*best.motion, rivals.matches, options);
  if (shifted) rivals.motions.push_back(*settled(*shifted, rivals.matches, options).motion);
  return rivals;
}

}  // namespace fathom
