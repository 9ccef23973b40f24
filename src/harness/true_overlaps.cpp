#include <algorithm>

#include "fathom/front_end/keyframe_grid.hpp"
#include "fathom/harness/recording_facts.hpp"
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

std::optional<TrueOverlaps> true_overlaps(const Recording& recording) {
  if (!recording.ground_truth || !recording.camera) return std::nullopt;
  const std::vector<Pose>& truth = *recording.ground_truth;
  TrueOverlaps overlaps;
  std::vector<double> reaches_m;
  for (const double altitude_m : recording.keyframe_altitudes_m) {
    reaches_m.push_back(reach_m(*recording.camera, altitude_m));
  }
  if (truth.empty()) return overlaps;
  const double most_m = std::ranges::max(reaches_m);
  KeyframeGrid grid(most_m > 0.0 ? 2.0 * most_m : 1.0);
  grid.follow(GivenTrajectory(truth));
  for (std::size_t i = 0; i < truth.size(); ++i) {
    for (const std::size_t k : grid.near(truth[i].position(), reaches_m[i] + most_m)) {
      const double apart_m = (truth[i].position() - truth[k].position()).norm();
      if (k <= i || apart_m > reaches_m[i] + reaches_m[k]) continue;
      const double overlap =
          footprint_overlap(*recording.camera, recording.keyframe_altitudes_m[i],
                            recording.keyframe_altitudes_m[k], between(truth[i], truth[k]));
      if (!(overlap > 0.0)) continue;
      overlaps.pairs.push_back(
          {static_cast<std::uint32_t>(i), static_cast<std::uint32_t>(k), overlap});
    }
  }
  overlaps.pairs.shrink_to_fit();
  return overlaps;
}

}  // namespace fathom
