#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Two keyframes, between which an estimated motion is judged.
struct KeyframePair {
  std::size_t from = 0;
  std::size_t to = 0;
  bool operator==(const KeyframePair&) const = default;
};

/// (k, k + separation) for every k of so many keyframes.
std::vector<KeyframePair> pairs_over_keyframes(std::size_t keyframes, std::size_t separation);

/// (k, first keyframe whose path length along the reference from k reaches `distance_m`) for every
/// k that has one.
std::vector<KeyframePair> pairs_over_distance(std::span<const Pose> reference, double distance_m);

/// (a, k) for `anchors` keyframes a in the middle of equally long parts of the log and, of each,
/// at most `most` other keyframes k, evenly spaced from the first to the last.
std::vector<KeyframePair> pairs_with_anchors(std::size_t keyframes, std::size_t anchors,
                                             std::size_t most);

/// At most `most` ≥ 1 of the places 0 … count − 1, evenly spaced, the first and, of more than one,
/// the last among them.
std::vector<std::size_t> evenly_spaced(std::size_t count, std::size_t most);

/// At most `most` of them, evenly_spaced.
std::vector<KeyframePair> thinned(std::span<const KeyframePair> pairs, std::size_t most);

}  // namespace fathom
