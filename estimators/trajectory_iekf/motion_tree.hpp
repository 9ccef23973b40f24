#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Which keyframes the motions of the state lead between. Without holes a chain: motion i leads
/// from keyframe i to i + 1. Where a loop has taken the place of the motion over a hole, it leads
/// between the loop's ends, and the motions are the edges of a tree.
class MotionTree {
 public:
  struct Ends {
    std::size_t from = 0;
    std::size_t to = 0;
  };

  /// Motion i leads from one keyframe to another from now on, not from i to i + 1.
  void set(std::size_t motion, const Ends& ends);

  bool is_chain() const { return others_.empty(); }
  Ends ends(std::size_t motion) const;

  /// A keyframe, reached from another one by a motion, along it or against it.
  struct Visit {
    std::size_t keyframe = 0;
    std::size_t from = 0;
    std::size_t motion = 0;
    bool is_along = true;
  };
  /// Of the tree of so many motions, all keyframes but the root, each after that it is reached
  /// from.
  std::vector<Visit> from(std::size_t root, std::size_t motions) const;

  /// Motions begin … end − 1, all along the way or all against it (sign −1).
  struct Part {
    std::size_t begin = 0;
    std::size_t end = 0;
    double sign = 1.0;
  };
  /// The way from one keyframe to another in the tree of so many motions; rising.
  std::vector<Part> way(std::size_t from, std::size_t to, std::size_t motions) const;

  /// Of every keyframe, with keyframe 0 at `origin`.
  std::vector<Pose> poses(const Pose& origin, std::span<const Pose> motions) const;

 private:
  struct Other {
    std::size_t motion = 0;
    Ends ends;
  };
  std::vector<Other> others_;  ///< motions that are not from i to i + 1
};

}  // namespace fathom
