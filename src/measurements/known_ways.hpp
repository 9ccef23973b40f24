#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fathom/core/disjoint_sets.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// A motion over several measurements.
struct KnownWay {
  UncertainPose motion;
  double length_m = 0.0;
};

/// What is known of the motions between keyframes, as measurements come in.
class KnownWays {
 public:
  explicit KnownWays(std::size_t keyframes)
      : lanes_(keyframes), reached_(keyframes), joined_(keyframes) {}

  void add(const RelativePose& z);

  /// The way with the least variance of heading, of several the first one found; nothing where none
  /// leads there.
  std::optional<KnownWay> best(std::size_t from, std::size_t to);

 private:
  /// A measurement as it leads from a keyframe to another one.
  struct Lane {
    std::size_t to = 0;
    UncertainPose motion;
  };
  /// What the last search found of a keyframe.
  struct Reached {
    double variance = 0.0;
    std::size_t from = 0;
    std::size_t lane = 0;
    bool is_settled = false;
    std::size_t search = 0;  ///< of which search this is
  };
  Reached& at(std::size_t keyframe);
  bool search(std::size_t from, std::size_t to);

  std::vector<std::vector<Lane>> lanes_;
  std::vector<Reached> reached_;
  DisjointSets joined_;  ///< so that nothing is searched where no way leads
  std::size_t search_ = 0;
};

}  // namespace fathom
