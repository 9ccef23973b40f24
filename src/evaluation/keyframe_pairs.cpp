#include "fathom/evaluation/keyframe_pairs.hpp"

#include <algorithm>
#include <cmath>

namespace fathom {
namespace {

// Path length from the first pose to each.
std::vector<double> path_lengths_m(std::span<const Pose> poses) {
  std::vector<double> lengths(poses.size(), 0.0);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    lengths[k] =
        lengths[k - 1] + std::hypot(poses[k].x - poses[k - 1].x, poses[k].y - poses[k - 1].y);
  }
  return lengths;
}

}  // namespace

std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t most) {
  std::vector<std::size_t> places;
  const std::size_t some = std::min(most, count);
  for (std::size_t i = 0; i < some; ++i) {
    places.push_back(some == 1 ? 0 : (i * (count - 1) + (some - 1) / 2) / (some - 1));
  }
  return places;
}

std::vector<KeyframePair> pairs_over_keyframes(std::size_t keyframes, std::size_t separation) {
  std::vector<KeyframePair> pairs;
  for (std::size_t to = separation; to < keyframes; ++to) pairs.push_back({to - separation, to});
  return pairs;
}

std::vector<KeyframePair> pairs_over_distance(std::span<const Pose> reference, double distance_m) {
  const std::vector<double> lengths = path_lengths_m(reference);
  // The sum of four steps of 1.25 m may be a little less than 5 m.
  const double rounding_m = lengths.empty() ? 0.0 : 1e-9 * lengths.back();
  std::vector<KeyframePair> pairs;
  for (std::size_t from = 0; from < lengths.size(); ++from) {
    const auto reached =
        std::lower_bound(lengths.begin(), lengths.end(), lengths[from] + distance_m - rounding_m);
    if (reached == lengths.end()) break;
    pairs.push_back({from, static_cast<std::size_t>(reached - lengths.begin())});
  }
  return pairs;
}

std::vector<KeyframePair> pairs_with_anchors(std::size_t keyframes, std::size_t anchors,
                                             std::size_t most) {
  std::vector<KeyframePair> pairs;
  const std::vector<std::size_t> others = evenly_spaced(keyframes, most);
  for (std::size_t a = 0; a < std::min(anchors, keyframes); ++a) {
    const std::size_t anchor = (2 * a + 1) * keyframes / (2 * std::min(anchors, keyframes));
    for (const std::size_t other : others) {
      if (other != anchor) pairs.push_back({anchor, other});
    }
  }
  return pairs;
}

std::vector<KeyframePair> thinned(std::span<const KeyframePair> pairs, std::size_t most) {
  std::vector<KeyframePair> some;
  for (const std::size_t place : evenly_spaced(pairs.size(), most)) some.push_back(pairs[place]);
  return some;
}

}  // namespace fathom
