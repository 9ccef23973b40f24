#include "fathom/evaluation/association.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fmt/format.h>
#include <string>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

void require_rising(std::span<const StampedPose> trajectory, const std::string& name) {
  for (std::size_t k = 1; k < trajectory.size(); ++k) {
    if (trajectory[k].time_ns > trajectory[k - 1].time_ns) continue;
    throw InputError(fmt::format("the time stamps of the {} must rise; pose {} at {} s does not",
                                 name, k, seconds_text(trajectory[k].time_ns)));
  }
}

struct Candidate {
  PosePair pair;
  std::uint64_t apart_ns = 0;
};

// Two signed 64-bit stamps may be further apart than a signed difference can tell.
std::uint64_t nanoseconds_apart(std::int64_t a, std::int64_t b) {
  return static_cast<std::uint64_t>(std::max(a, b)) - static_cast<std::uint64_t>(std::min(a, b));
}

// The pairs that are next to each other once both trajectories are merged by time: any other pair
// would reach across a pose.
std::vector<Candidate> neighbours(std::span<const StampedPose> estimate,
                                  std::span<const StampedPose> reference) {
  std::vector<Candidate> candidates;
  std::size_t e = 0;
  std::size_t r = 0;
  while (e < estimate.size() && r < reference.size()) {
    const std::int64_t t_estimate = estimate[e].time_ns;
    const std::int64_t t_reference = reference[r].time_ns;
    const bool estimate_first = t_estimate <= t_reference;
    const bool next_is_own =
        estimate_first ? e + 1 < estimate.size() && estimate[e + 1].time_ns <= t_reference
                       : r + 1 < reference.size() && reference[r + 1].time_ns < t_estimate;
    if (!next_is_own) candidates.push_back({{e, r}, nanoseconds_apart(t_estimate, t_reference)});
    ++(estimate_first ? e : r);
  }
  return candidates;
}

}  // namespace

std::vector<PosePair> associate(std::span<const StampedPose> estimate,
                                std::span<const StampedPose> reference, double max_difference_s) {
  require_rising(estimate, "estimate");
  require_rising(reference, "reference");
  if (!(max_difference_s >= 0.0)) {
    throw InputError("the time difference allowed must be 0 s or more, got " +
                     std::to_string(max_difference_s));
  }
  std::vector<Candidate> candidates = neighbours(estimate, reference);
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return a.apart_ns < b.apart_ns; });
  const double limit_ns = std::round(max_difference_s * 1e9);
  std::vector<bool> estimate_taken(estimate.size());
  std::vector<bool> reference_taken(reference.size());
  std::vector<PosePair> pairs;
  for (const auto& [pair, apart_ns] : candidates) {
    if (static_cast<double>(apart_ns) > limit_ns) break;
    if (estimate_taken[pair.estimate] || reference_taken[pair.reference]) continue;
    estimate_taken[pair.estimate] = true;
    reference_taken[pair.reference] = true;
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const PosePair& a, const PosePair& b) { return a.estimate < b.estimate; });
  return pairs;
}

AssociatedPoses paired_poses(std::span<const StampedPose> estimate,
                             std::span<const StampedPose> reference,
                             std::span<const PosePair> pairs) {
  AssociatedPoses poses;
  for (const PosePair& pair : pairs) {
    poses.estimate.push_back(estimate[pair.estimate].pose);
    poses.reference.push_back(reference[pair.reference].pose);
  }
  return poses;
}

}  // namespace fathom
