#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

/// Indices of an estimate's pose and the reference's pose that belong together.
struct PosePair {
  std::size_t estimate = 0;
  std::size_t reference = 0;

  bool operator==(const PosePair&) const = default;
};

/// Pairs two trajectories by time stamp, one to one and in order of time: nearest pairs first (of
/// equally near ones the earlier), none further apart than `max_difference_s` (included), none
/// reaching across another. What finds no partner is left out.
/// Throws InputError unless both trajectories rise in time and the difference is zero or more.
std::vector<PosePair> associate(std::span<const StampedPose> estimate,
                                std::span<const StampedPose> reference, double max_difference_s);

/// Two lists of the same length whose k-th poses belong together.
struct AssociatedPoses {
  std::vector<Pose> estimate;
  std::vector<Pose> reference;
};

AssociatedPoses paired_poses(std::span<const StampedPose> estimate,
                             std::span<const StampedPose> reference,
                             std::span<const PosePair> pairs);

}  // namespace fathom
