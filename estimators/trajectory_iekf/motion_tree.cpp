#include "estimators/trajectory_iekf/motion_tree.hpp"

#include <algorithm>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

void MotionTree::set(std::size_t motion, const Ends& ends) {
  const auto other = std::ranges::find(others_, motion, &Other::motion);
  if (other != others_.end()) {
    other->ends = ends;
  } else {
    others_.push_back({motion, ends});
  }
}

MotionTree::Ends MotionTree::ends(std::size_t motion) const {
  const auto other = std::ranges::find(others_, motion, &Other::motion);
  return other == others_.end() ? Ends{motion, motion + 1} : other->ends;
}

std::vector<MotionTree::Visit> MotionTree::from(std::size_t root, std::size_t motions) const {
  // Of keyframe k the motions at it: k − 1 and k, unless they are others, and some of those.
  std::vector<std::vector<std::size_t>> at(motions + 1);
  for (std::size_t i = 0; i < motions; ++i) {
    const Ends e = ends(i);
    at[e.from].push_back(i);
    at[e.to].push_back(i);
  }
  std::vector<Visit> visits;
  visits.reserve(motions);
  std::vector<char> is_reached(motions + 1, 0);
  is_reached[root] = 1;
  std::vector<std::size_t> open{root};
  while (!open.empty()) {
    const std::size_t k = open.back();
    open.pop_back();
    for (const std::size_t i : at[k]) {
      const Ends e = ends(i);
      const bool is_along = e.from == k;
      const std::size_t next = is_along ? e.to : e.from;
      if (is_reached[next] != 0) continue;
      is_reached[next] = 1;
      visits.push_back({next, k, i, is_along});
      open.push_back(next);
    }
  }
  return visits;
}

std::vector<MotionTree::Part> MotionTree::way(std::size_t from, std::size_t to,
                                              std::size_t motions) const {
  if (is_chain()) return {{from, to, 1.0}};
  std::vector<Visit> visit_of(motions + 1);
  for (const Visit& v : this->from(to, motions)) visit_of[v.keyframe] = v;
  std::vector<Part> way;
  for (std::size_t k = from; k != to; k = visit_of[k].from) {
    const Visit& v = visit_of[k];
    way.push_back({v.motion, v.motion + 1, v.is_along ? -1.0 : 1.0});
  }
  std::ranges::sort(way, {}, &Part::begin);
  std::vector<Part> parts;
  for (const Part& part : way) {
    if (!parts.empty() && parts.back().end == part.begin && parts.back().sign == part.sign) {
      parts.back().end = part.end;
    } else {
      parts.push_back(part);
    }
  }
  return parts;
}

std::vector<Pose> MotionTree::poses(const Pose& origin, std::span<const Pose> motions) const {
  if (is_chain()) return compose_trajectory(origin, motions);
  std::vector<Pose> poses(motions.size() + 1);
  poses[0] = origin;
  for (const Visit& v : from(0, motions.size())) {
    const Pose& motion = motions[v.motion];
    poses[v.keyframe] = compose(poses[v.from], v.is_along ? motion : inverse(motion));
  }
  return poses;
}

}  // namespace fathom
