#include "match_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <tuple>
#include <utility>

namespace fathom {
namespace {

const Eigen::Vector2d& point(const FloorFeatures& picture, int row) {
  return picture.points[static_cast<std::size_t>(row)];
}

std::vector<Match> one_per_place(std::vector<Match> matches, const FloorFeatures& from,
                                 const FloorFeatures& to) {
  const auto place = [&](const Match& m) {
    const Eigen::Vector2d& p = point(from, m.from);
    const Eigen::Vector2d& q = point(to, m.to);
    return std::array{p.x(), p.y(), q.x(), q.y()};
  };
  // A point that is no number would match nothing, and cannot be ordered.
  std::erase_if(matches, [&](const Match& m) {
    return !point(from, m.from).allFinite() || !point(to, m.to).allFinite();
  });
  std::ranges::sort(matches, [&](const Match& a, const Match& b) {
    return std::tuple(place(a), a.distance, a.from, a.to) <
           std::tuple(place(b), b.distance, b.from, b.to);
  });
  const auto same_place = [&](const Match& a, const Match& b) { return place(a) == place(b); };
  matches.erase(std::unique(matches.begin(), matches.end(), same_place), matches.end());
  std::ranges::sort(matches, {}, [](const Match& m) { return std::pair(m.from, m.to); });
  return matches;
}

}  // namespace

MatchSet::MatchSet(std::vector<Match> matches, const FloorFeatures& from, const FloorFeatures& to,
                   Use use, const MatchingTuning& tuning)
    : MatchSet(tuning.turn_tolerance_rad) {
  const bool sized = use == Use::sizes && !from.sizes_m.empty() && !to.sizes_m.empty();
  if (sized) {
    std::erase_if(matches, [&](const Match& m) {
      const double ratio = from.sizes_m[static_cast<std::size_t>(m.from)] /
                           to.sizes_m[static_cast<std::size_t>(m.to)];
      return ratio > tuning.size_ratio || ratio < 1.0 / tuning.size_ratio;
    });
  }
  matches_ = one_per_place(std::move(matches), from, to);
  for (const Match& m : matches_) {
    const auto i = static_cast<std::size_t>(m.from);
    const auto j = static_cast<std::size_t>(m.to);
    p_.push_back(from.points[i]);
    q_.push_back(to.points[j]);
    if (!sized) continue;
    turns_rad_.push_back(from.headings_rad[i] - to.headings_rad[j]);
    relative_variances_.push_back(from.sizes_m[i] * from.sizes_m[i] +
                                  to.sizes_m[j] * to.sizes_m[j]);
  }
  pairs_ = PointPairs(p_, q_, turns_rad_, turn_tolerance_rad_);
}

double MatchSet::relative_variance(int index) const {
  return relative_variances_.empty() ? 1.0 : relative_variances_[static_cast<std::size_t>(index)];
}

std::vector<int> MatchSet::one_to_one(const std::vector<int>& indices) const {
  std::vector<int> order = indices;
  std::ranges::stable_sort(
      order, {}, [this](int index) { return matches_[static_cast<std::size_t>(index)].distance; });
  std::set<int> from_taken;
  std::set<int> to_taken;
  std::vector<int> kept;
  for (const int index : order) {
    const Match& m = matches_[static_cast<std::size_t>(index)];
    if (from_taken.contains(m.from) || to_taken.contains(m.to)) continue;
    from_taken.insert(m.from);
    to_taken.insert(m.to);
    kept.push_back(index);
  }
  std::ranges::sort(kept);
  return kept;
}

MatchSet MatchSet::without(const std::vector<int>& indices) const {
  MatchSet rest(turn_tolerance_rad_);
  std::size_t next = 0;
  for (std::size_t i = 0; i < size(); ++i) {
    if (next < indices.size() && static_cast<std::size_t>(indices[next]) == i) {
      ++next;
      continue;
    }
    rest.matches_.push_back(matches_[i]);
    rest.p_.push_back(p_[i]);
    rest.q_.push_back(q_[i]);
    if (turns_rad_.empty()) continue;
    rest.turns_rad_.push_back(turns_rad_[i]);
    rest.relative_variances_.push_back(relative_variances_[i]);
  }
  rest.pairs_ = PointPairs(rest.p_, rest.q_, rest.turns_rad_, turn_tolerance_rad_);
  return rest;
}

}  // namespace fathom
