#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "fathom/core/options.hpp"
#include "fathom/datasets/frame_source.hpp"

namespace fathom {

/// Which frames become keyframes.
struct KeyframeOptions {
  double kept_overlap = 0.85;            ///< of two in a row, as dead reckoning has it
  std::optional<int> separation_frames;  ///< one every so many frames instead

  /// Frames from one keyframe to the next, at least: by overlap any frame may be one.
  int least_separation() const { return separation_frames.value_or(1); }

  void describe(OptionTable& table);

  /// Keys, as described, that have no effect beside `separation_frames`.
  std::vector<std::string> ignored_keys() const;
};

/// The frames of a survey that are keyframes: frame 0, then one every `separation_frames`, or each
/// time the last frame whose picture still shares `kept_overlap` with that of the keyframe before
/// (the next one, where not even that does). Both shares are of the smaller footprint, with
/// altitudes as measured and the motion as dead reckoning has it, so the schedule is the same for
/// all who look at a survey. No single altitude decides it: of two footprints of the smaller of
/// their altitudes half of `kept_overlap` must be shared, too. By overlap the frames on both sides
/// of a hole in dead reckoning are keyframes, too: nobody knows what they share, and what was
/// measured around it stays known.
class KeyframeSchedule {
 public:
  /// The source must have odometry where keyframes go by overlap, and outlive this.
  KeyframeSchedule(const FrameSource& source, const KeyframeOptions& options)
      : source_(source), options_(options) {}

  /// The frame of keyframe k; nothing beyond the last one. By overlap, frames up to the one after
  /// it are looked at, in order.
  std::optional<std::size_t> frame(std::size_t k);

 private:
  bool shares_enough(const Stance& keyframe, const Stance& frame, const Pose& motion) const;
  std::optional<std::size_t> after(std::size_t keyframe) const;

  const FrameSource& source_;
  KeyframeOptions options_;
  std::vector<std::size_t> frames_;  ///< of the first keyframes
};

/// What refuses a survey of so many frames that comes to a single keyframe, by the key that makes
/// it so.
InputError single_keyframe(const KeyframeOptions& keyframes, std::size_t frames);

}  // namespace fathom
