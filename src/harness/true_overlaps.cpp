#include <algorithm>
#include <set>
#include <utility>

#include "fathom/harness/run_record.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

// No point of a footprint is further from the body than this.
double reach_m(const Camera& camera, double altitude_m) {
  double reach = 0.0;
  for (const Eigen::Vector2d& corner : camera.footprint(altitude_m)) {
    reach = std::max(reach, corner.norm());
  }
  return reach;
}

}  // namespace

double TrueOverlaps::of(std::size_t i, std::size_t k) const {
  const auto key = [](const Pair& pair) { return std::pair(pair.i, pair.k); };
  const auto found = std::ranges::lower_bound(pairs, std::pair(i, k), {}, key);
  return found != pairs.end() && key(*found) == std::pair(i, k) ? found->overlap : 0.0;
}

std::optional<TrueOverlaps> true_overlaps(const Recording& recording) {
  if (!recording.ground_truth || !recording.camera) return std::nullopt;
  const std::vector<Pose>& truth = *recording.ground_truth;
  TrueOverlaps overlaps;
  std::vector<double> reaches_m;
  for (const double altitude_m : recording.keyframe_altitudes_m) {
    reaches_m.push_back(reach_m(*recording.camera, altitude_m));
  }
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (std::size_t k = i + 1; k < truth.size(); ++k) {
      const double apart_m = (truth[i].position() - truth[k].position()).norm();
      if (apart_m > reaches_m[i] + reaches_m[k]) continue;
      const double overlap =
          footprint_overlap(*recording.camera, recording.keyframe_altitudes_m[i],
                            recording.keyframe_altitudes_m[k], between(truth[i], truth[k]));
      if (overlap > 0.0) overlaps.pairs.push_back({i, k, overlap});
    }
  }
  return overlaps;
}

std::optional<double> loop_precision(const std::vector<LoopDecision>& loops,
                                     const TrueOverlaps& truth) {
  std::size_t used = 0;
  std::size_t right = 0;
  for (const LoopDecision& loop : loops) {
    if (loop.fate != LoopFate::used) continue;
    ++used;
    if (truth.of(std::min(loop.from, loop.to), std::max(loop.from, loop.to)) > 0.0) ++right;
  }
  if (used == 0) return std::nullopt;
  return static_cast<double>(right) / static_cast<double>(used);
}

std::optional<double> loop_recall(const std::vector<LoopDecision>& loops, const TrueOverlaps& truth,
                                  double min_overlap) {
  std::set<std::pair<std::size_t, std::size_t>> used;
  for (const LoopDecision& loop : loops) {
    if (loop.fate != LoopFate::used) continue;
    used.emplace(std::min(loop.from, loop.to), std::max(loop.from, loop.to));
  }
  std::size_t pairs = 0;
  std::size_t found = 0;
  for (const TrueOverlaps::Pair& pair : truth.pairs) {
    if (pair.overlap < min_overlap) continue;
    ++pairs;
    if (used.contains({pair.i, pair.k})) ++found;
  }
  if (pairs == 0) return std::nullopt;
  return static_cast<double>(found) / static_cast<double>(pairs);
}

}  // namespace fathom
