#include <algorithm>

#include "fathom/geometry/keyframe_grid.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

// No point of a footprint is further from the body than this.
double reach_m(const Camera& camera, const Stance& stance) {
  double reach = 0.0;
  for (const Eigen::Vector2d& corner : camera.footprint(stance)) {
    reach = std::max(reach, corner.norm());
  }
  return reach;
}

}  // namespace

TrueOverlaps overlaps_at(std::span<const Pose> poses, const Camera& camera,
                         std::span<const Stance> stances) {
  TrueOverlaps overlaps;
  std::vector<double> reaches_m;
  for (const Stance& stance : stances) reaches_m.push_back(reach_m(camera, stance));
  if (poses.empty()) return overlaps;
  const double most_m = std::ranges::max(reaches_m);
  KeyframeGrid grid(most_m > 0.0 ? 2.0 * most_m : 1.0);
  grid.follow(GivenTrajectory({poses.begin(), poses.end()}));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (const std::size_t k : grid.near(poses[i].position(), reaches_m[i] + most_m)) {
      const double apart_m = (poses[i].position() - poses[k].position()).norm();
      if (k <= i || apart_m > reaches_m[i] + reaches_m[k]) continue;
      const double overlap =
          footprint_overlap(camera, stances[i], stances[k], between(poses[i], poses[k]));
      if (!(overlap > 0.0)) continue;
      overlaps.pairs.push_back(
          {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), overlap});
    }
  }
  overlaps.pairs.shrink_to_fit();
  return overlaps;
}

std::optional<TrueOverlaps> true_overlaps(const Recording& recording) {
  if (!recording.ground_truth || !recording.camera) return std::nullopt;
  return overlaps_at(*recording.ground_truth, *recording.camera, recording.keyframe_stances);
}

}  // namespace fathom
