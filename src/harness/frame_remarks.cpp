#include "fathom/harness/frame_remarks.hpp"

#include <algorithm>
#include <cstdint>
#include <fmt/format.h>
#include <iterator>
#include <vector>

#include "fathom/core/text.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

bool shares_floor(const Camera& camera, Stance keyframe, Stance frame, const Pose& motion) {
  keyframe.altitude_m = frame.altitude_m = std::min(keyframe.altitude_m, frame.altitude_m);
  return footprint_overlap(camera, keyframe, frame, motion) > 0.0;
}

// Whether registrations of a keyframe beside it say something of the frame.
bool has_keyframe(const Recording& recording, std::size_t frame) {
  const Camera& camera = *recording.camera;
  const auto& [time_ns, k, since] = recording.frames[frame];
  const Stance& stance = recording.frame_stances[frame];
  if (shares_floor(camera, recording.keyframe_stances[k], stance, since)) return true;
  if (k + 1 >= recording.log.size()) return false;
  const Pose to_next = between(since, recording.log.arrival(k + 1).step.forward().motion);
  return shares_floor(camera, stance, recording.keyframe_stances[k + 1], to_next);
}

}  // namespace

std::optional<std::string> frame_remark(const Recording& recording) {
  if (!recording.camera || recording.frame_stances.empty()) return std::nullopt;
  std::size_t count = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    if (has_keyframe(recording, i)) continue;
    if (count++ == 0) first = i;
  }
  if (count == 0) return std::nullopt;
  return fmt::format(
      "{} of {} frames share no floor with the keyframe before or after them (the first is frame "
      "{}, t = {} s): dead reckoning alone says where they are; more keyframes would correct them "
      "(front_end.keyframes), or an altitude that is right",
      count, recording.frames.size(), first, seconds_text(recording.frames[first].time_ns));
}

std::optional<std::string> truth_remark(const Recording& recording) {
  const std::vector<StampedPose>& truth = recording.frame_ground_truth;
  if (recording.ground_truth || truth.empty()) return std::nullopt;
  std::vector<std::int64_t> without;
  std::ranges::copy_if(
      recording.keyframe_times_ns, std::back_inserter(without), [&truth](std::int64_t time_ns) {
        return !std::ranges::binary_search(truth, time_ns, {}, &StampedPose::time_ns);
      });
  if (without.empty()) return std::nullopt;
  return fmt::format(
      "ground truth is missing at {} of {} keyframes (the first at t = {} s), so no error is "
      "computed; 'fathom evaluate trajectory.tum ground_truth.tum' in a run's folder compares the "
      "others",
      without.size(), recording.keyframe_times_ns.size(), seconds_text(without.front()));
}

}  // namespace fathom
