#include "known_ways.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace fathom {

void KnownWays::add(const RelativePose& z) {
  const RelativePose back = z.reversed();
  lanes_[z.from].push_back({z.to, {z.motion, z.covariance()}});
  lanes_[z.to].push_back({z.from, {back.motion, back.covariance()}});
  joined_.join(z.from, z.to);
}

KnownWays::Reached& KnownWays::at(std::size_t keyframe) {
  Reached& one = reached_[keyframe];
  if (one.search != search_) {
    one = {std::numeric_limits<double>::infinity(), keyframe, 0, false, search_};
  }
  return one;
}

// Dijkstra 1959. It ends at the goal, so that a short way costs little in a long log.
bool KnownWays::search(std::size_t from, std::size_t to) {
  ++search_;
  using Entry = std::pair<double, std::size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  at(from).variance = 0.0;
  open.emplace(0.0, from);
  while (!open.empty()) {
    const auto [variance, k] = open.top();
    open.pop();
    if (at(k).is_settled) continue;
    at(k).is_settled = true;
    if (k == to) return true;
    for (std::size_t i = 0; i < lanes_[k].size(); ++i) {
      const Lane& lane = lanes_[k][i];
      const double there = variance + lane.motion.covariance(2, 2);
      Reached& next = at(lane.to);
      if (!(there < next.variance)) continue;
      next.variance = there;
      next.from = k;
      next.lane = i;
      open.emplace(there, lane.to);
    }
  }
  return false;
}

std::optional<KnownWay> KnownWays::best(std::size_t from, std::size_t to) {
  if (joined_.root(from) != joined_.root(to) || !search(from, to)) return std::nullopt;
  std::vector<UncertainPose> motions;
  KnownWay way;
  for (std::size_t k = to; k != from; k = reached_[k].from) {
    motions.push_back(lanes_[reached_[k].from][reached_[k].lane].motion);
    way.length_m += motions.back().mean.position().norm();
  }
  std::ranges::reverse(motions);
  way.motion = compose_chain(motions);
  return way;
}

}  // namespace fathom
