#include "fathom/front_end/keyframes.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/pose.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

void KeyframeOptions::describe(OptionTable& table) {
  table.real("min_overlap", kept_overlap, Range{0.0, 1.0, true}, "",
             "a keyframe at the last frame that shares so much of its footprint with the keyframe "
             "before, by dead reckoning");
  table.integer_or_off("separation_frames", separation_frames, Range::at_least(1), "frames",
                       "a keyframe every so many frames, whatever they share");
}

std::vector<std::string> KeyframeOptions::ignored_keys() const {
  if (separation_frames) return {"min_overlap"};
  return {};
}

// As dead reckoning has it. A small footprint within a large one shares all of itself wherever it
// is; so two of the smaller one, where the altitudes have them, must share half as much.
bool KeyframeSchedule::shares_enough(const Stance& keyframe, const Stance& frame,
                                     const Pose& motion) const {
  const Camera& camera = source_.camera();
  if (footprint_overlap(camera, keyframe, frame, motion) < options_.kept_overlap) return false;
  Stance low_keyframe = keyframe;
  Stance low_frame = frame;
  low_keyframe.altitude_m = low_frame.altitude_m = std::min(keyframe.altitude_m, frame.altitude_m);
  constexpr double kHalf = 0.5;
  return !(footprint_overlap(camera, low_keyframe, low_frame, motion) <
           kHalf * options_.kept_overlap);
}

std::optional<std::size_t> KeyframeSchedule::after(std::size_t keyframe) const {
  if (options_.separation_frames) {
    const std::size_t next = keyframe + static_cast<std::size_t>(*options_.separation_frames);
    return next < source_.size() ? std::optional(next) : std::nullopt;
  }
  const Stance stance = source_.info(keyframe).stance();
  Pose motion;
  for (std::size_t frame = keyframe + 1; frame < source_.size(); ++frame) {
    const FrameInfo& info = source_.info(frame);
    motion = compose(motion, info.motion->mean);
    if (shares_enough(stance, info.stance(), motion) && !info.is_hole) continue;
    return frame - 1 > keyframe ? frame - 1 : frame;
  }
  return std::nullopt;
}

std::optional<std::size_t> KeyframeSchedule::frame(std::size_t k) {
  while (frames_.size() <= k) {
    const auto next = frames_.empty()
                          ? (source_.size() > 0 ? std::optional<std::size_t>(0) : std::nullopt)
                          : after(frames_.back());
    if (!next) return std::nullopt;
    frames_.push_back(*next);
  }
  return frames_[k];
}

InputError single_keyframe(const KeyframeOptions& keyframes, std::size_t frames) {
  const std::string count = counted(frames, "frame");
  if (frames < 2) return InputError("dataset: has " + count + "; a survey has two or more");
  if (!keyframes.separation_frames) {
    return InputError("front_end.keyframes.min_overlap: by dead reckoning all of " + count +
                      " share so much of the floor, so there is a single keyframe; expected " +
                      "front_end.keyframes.separation_frames");
  }
  return InputError(
      fmt::format("front_end.keyframes.separation_frames: {} leads beyond the last of {}, so there "
                  "is a single keyframe; expected at most {}",
                  *keyframes.separation_frames, count, frames - 1));
}

}  // namespace fathom
