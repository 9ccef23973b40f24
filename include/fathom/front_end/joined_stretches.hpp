#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace fathom {

/// Keyframes in the stretches that holes in dead reckoning part, and which of these stretches are
/// joined: it is known how they lie to each other.
class JoinedStretches {
 public:
  /// Takes over keyframes up to `count`, which never falls. `holes`, rising: the keyframes that a
  /// hole leads to, each the first of a stretch that is joined to none.
  void extend(std::size_t count, std::span<const std::size_t> holes);

  /// Keyframes taken over.
  std::size_t size() const { return stretch_of_.size(); }
  /// Whether all are joined to each other, as where there is no hole.
  bool are_one() const { return apart_ == 0; }
  /// Of two keyframes, whether their stretches are joined.
  bool are_joined(std::size_t a, std::size_t b) const { return group(a) == group(b); }
  /// Joins the stretches of two keyframes, and all that are joined to either.
  void join(std::size_t a, std::size_t b);

 private:
  std::size_t group(std::size_t keyframe) const { return groups_[stretch_of_[keyframe]]; }

  std::vector<std::size_t> stretch_of_;  ///< by keyframe
  std::vector<std::size_t> groups_;      ///< by stretch: the first one of those joined
  std::size_t apart_ = 0;                ///< groups beside the first
};

/// Places 0 … count − 1 that have their turn, `most` at most, evenly spread. Where not all have it
/// at once, consecutive turns take others: with s the least number from count / most on that
/// neither 2 nor 3 divides, every place has its turn within s turns; so has one that moves on, or
/// back, by a place a turn.
std::vector<std::size_t> in_turn(std::size_t count, std::size_t most, std::size_t turn);

}  // namespace fathom
