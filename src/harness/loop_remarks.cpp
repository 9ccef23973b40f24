#include "fathom/harness/loop_remarks.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <optional>
#include <utility>

#include "fathom/core/text.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

std::string range_text(const Spread& spread) {
  const std::string least = short_number(spread.least);
  const std::string most = short_number(spread.most);
  return least == most ? least : least + " to " + most;
}

struct Pass {
  double distance_m = std::numeric_limits<double>::infinity();
  std::size_t from = 0;
  std::size_t to = 0;
};

// The nearest that dead reckoning comes to where it was before: of keyframes with a path between
// them of several times the reach, and of twice their distance, so that it turned back. Of a long
// survey some keyframes stand for all.
Pass nearest_pass(const std::vector<Pose>& poses, double reach_m) {
  constexpr double kPath = 4.0;
  constexpr std::size_t kLooked = 2000;
  const std::size_t stride = poses.size() / kLooked + 1;
  std::vector<double> path_m(poses.size(), 0.0);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    path_m[k] = path_m[k - 1] + (poses[k].position() - poses[k - 1].position()).norm();
  }
  Pass nearest;
  for (std::size_t k = 0; k < poses.size(); k += stride) {
    for (std::size_t j = 0; j < k && path_m[k] - path_m[j] > kPath * reach_m; j += stride) {
      const double distance_m = (poses[k].position() - poses[j].position()).norm();
      if (2.0 * distance_m > path_m[k] - path_m[j]) continue;
      if (distance_m < nearest.distance_m) nearest = {distance_m, j, k};
    }
  }
  return nearest;
}

std::string no_candidates(const Recording& recording) {
  const Spread& reach_m = recording.in_metres->reach_m;
  const Pass pass = nearest_pass(recording.log.odometry(), reach_m.most);
  std::string text = fmt::format(
      "no loop candidates among {} keyframes: none has an earlier one within reach, {} m; ",
      recording.log.size(), range_text(reach_m));
  if (!std::isfinite(pass.distance_m)) {
    return text +
           "by dead reckoning the path never returns to where it was, so there is nothing to "
           "correct it";
  }
  return text + "by dead reckoning the nearest pass, keyframes " + std::to_string(pass.from) +
         " and " + std::to_string(pass.to) + ", is " + short_number(pass.distance_m) +
         " m away: a larger front_end.candidates.max_distance_m, or a dead reckoning whose "
         "covariance says how far it may be off";
}

std::string none_registered(const Recording& recording, const FrontEndOptions& options) {
  return fmt::format(
      "0 of {} candidate pairs registered: in the best of them {} matches agree, where at least {} "
      "are needed, and more than chance would bring together: look at altitude and focal length, "
      "at the pictures' texture ('fathom check DIR'), at whether the camera looks straight down "
      "(attitude0 takes its tilt) on a flat floor, at front_end.ransac.max_error_px where pictures "
      "are large, and at a pair that should match ('fathom register A B')",
      recording.registrations_tried, recording.most_refused_inliers,
      options.registration.ransac.min_inliers);
}

// Pairs of keyframes that share enough floor for a registration to be expected.
struct Overlapping {
  std::size_t pairs = 0;
  std::size_t registered = 0;
};

constexpr double kEnoughOverlap = 0.3;

Overlapping overlapping(const Recording& recording, std::span<const Pose> estimate) {
  const TrueOverlaps overlaps =
      overlaps_at(estimate, *recording.camera, recording.keyframe_stances);
  Overlapping count;
  for (const TrueOverlaps::Pair& pair : overlaps.pairs) {
    if (pair.overlap >= kEnoughOverlap) ++count.pairs;
  }
  for (std::size_t k = 1; k < recording.log.size(); ++k) {
    for (const RelativePose& z : recording.log.arrival(k).registrations) {
      const auto [first, last] = std::minmax(z.from, z.to);
      if (overlaps.of(first, last) >= kEnoughOverlap) ++count.registered;
    }
  }
  return count;
}

std::string few_registered(const Recording& recording, const Overlapping& count) {
  return fmt::format(
      "{} registrations, where by the estimate {} pairs of keyframes share 30 % of a picture or "
      "more ({} tried, {} found{}; of those refused the best has {} matches that agree): altitude "
      "and focal length, the pictures' texture and blur, or a larger front_end.ransac.max_error_px",
      count.registered, count.pairs, recording.registrations_tried,
      recording.log.registration_count(),
      recording.registrations_left_out > 0
          ? fmt::format(", {} beyond the budget", recording.registrations_left_out)
          : "",
      recording.most_refused_inliers);
}

}  // namespace

std::vector<std::string> loop_remarks(const Recording& recording, const FrontEndOptions& options,
                                      std::span<const Pose> estimate) {
  if (!recording.in_metres || !recording.camera) return {};
  if (recording.registrations_tried == 0) return {no_candidates(recording)};
  if (recording.log.registration_count() == 0) return {none_registered(recording, options)};
  std::vector<std::string> remarks;
  constexpr std::size_t kEnough = 5;
  constexpr double kShare = 0.5;
  const Overlapping count = overlapping(recording, estimate);
  // A budget may leave pairs untried.
  const std::size_t expected = std::min(count.pairs, recording.registrations_tried);
  if (expected >= kEnough &&
      static_cast<double>(count.registered) < kShare * static_cast<double>(expected)) {
    remarks.push_back(few_registered(recording, count));
  }
  return remarks;
}

}  // namespace fathom
