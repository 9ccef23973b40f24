// Which candidates are taken where there are more than may be.

#include <algorithm>

#include "fathom/front_end/candidates.hpp"

namespace fathom {

// So many at most, by their rank.
std::vector<std::size_t> CandidateSearch::best(const TrajectoryView& trajectory,
                                               std::span<const Stance> stances,
                                               const std::vector<Chance>& candidates,
                                               std::optional<std::size_t> most) const {
  std::vector<std::size_t> keyframes;
  if (!most || candidates.size() <= *most) {
    for (const Chance& candidate : candidates) keyframes.push_back(candidate.keyframe);
    return keyframes;
  }
  const bool by_passes = method_ == CandidateMethod::possible_overlap;
  const std::vector<Rank> ranks = ranked(trajectory, stances, candidates);
  for (const std::size_t place : by_passes ? order_by_passes(ranks) : order_of(ranks)) {
    keyframes.push_back(ranks[place].keyframe);
  }
  keyframes.resize(*most);
  std::ranges::sort(keyframes);
  return keyframes;
}

// Most overlap first, then the likeliest, the nearest, the earliest.
std::vector<CandidateSearch::Rank> CandidateSearch::ranked(
    const TrajectoryView& trajectory, std::span<const Stance> stances,
    const std::vector<Chance>& candidates) const {
  const std::size_t newest = stances.size() - 1;
  std::vector<Rank> ranks;
  for (const auto& [k, squared_sigmas] : candidates) {
    const Pose motion = between(trajectory.pose(k), trajectory.pose(newest));
    ranks.push_back({-overlap(motion, stances[k], stances[newest]), squared_sigmas,
                     motion.position().norm(), k});
  }
  return ranks;
}

std::vector<std::size_t> CandidateSearch::order_of(const std::vector<Rank>& ranks) {
  std::vector<std::size_t> order = consecutive(0, ranks.size());
  std::ranges::sort(order, {}, [&](std::size_t place) { return ranks[place]; });
  return order;
}

// The best of each pass, by their rank, then the second best of each, and so on. `ranks` are by
// rising keyframe.
std::vector<std::size_t> CandidateSearch::order_by_passes(const std::vector<Rank>& ranks) {
  std::vector<std::size_t> pass(ranks.size(), 0);
  for (std::size_t i = 1; i < ranks.size(); ++i) {
    const bool follows = ranks[i].keyframe == ranks[i - 1].keyframe + 1;
    pass[i] = pass[i - 1] + (follows ? 0 : 1);
  }
  std::vector<std::size_t> order = order_of(ranks);
  std::vector<std::size_t> taken(ranks.size(), 0);
  std::vector<std::size_t> round(ranks.size());
  for (const std::size_t place : order) round[place] = taken[pass[place]]++;
  std::ranges::stable_sort(order, {}, [&](std::size_t place) { return round[place]; });
  return order;
}

}  // namespace fathom
