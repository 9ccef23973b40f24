#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "fathom/datasets/absolute_readings.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/start_options.hpp"
#include "fathom/measurements/absolute_pose.hpp"

namespace fathom {

/// A frame as dead reckoning has it.
struct DeadReckonedFrame {
  std::int64_t time_ns = 0;
  UncertainPose motion;  ///< since the frame before, in that frame; of frame 0: none
  bool is_hole = false;  ///< `motion` was not measured
};

/// The frames of a survey in their order; asked for by rising index.
struct DeadReckoning {
  std::size_t size = 0;
  std::function<DeadReckonedFrame(std::size_t)> frame;
};

/// Of frames that have odometry. They must outlive it.
DeadReckoning dead_reckoning_of(const FrameSource& frames);

/// What keyframe 0 begins with where `dataset.start` does not say it: as many standard deviations
/// as a reading has that two others of the first ten agree with. That reading stays in the log, and
/// counts for 1¼ readings then. Wider, a jump of ten σ would be taken for the place of keyframe 0,
/// and every right fix after it for a jump.
inline constexpr double kAgreedStartWidth = 2.0;
/// Where there are no such three: so wide that the first reading counts once.
inline constexpr double kStartWidth = 100.0;
/// Standard deviations of what the gauge holds beside something that is uncertain: a covariance has
/// to be positive definite.
inline constexpr double kHeldSigma_m = 1e-4;
inline constexpr double kHeldSigma_rad = 1e-5;

/// Where keyframe 0 is, and how well that is known:
/// - position and heading as the options give them;
/// - else by a fix and by a heading, those with which most of the first ten agree, carried back to
///   frame 0 by dead reckoning; `kAgreedStartWidth` or `kStartWidth` times as wide as these;
/// - else, of what nothing measures, zero and held: the gauge.
/// Throws InputError "dataset.start.heading_rad: …" where there are fixes and nothing says the
/// heading.
StartPose start_of(const StartOptions& options, const AbsoluteReadings& readings,
                   const DeadReckoning& frames);

/// Turns readings between keyframes into measurements of keyframes: each is carried to the keyframe
/// before by dead reckoning, its covariance included; over a hole to the keyframe after, if it was
/// taken between the hole and that one. Motions between frames are divided at constant velocity
/// (part_of). What a fix says of the heading is linearised at the heading of dead reckoning from
/// the start on, corrected by the compass as far as each is known.
class ReadingCarrier {
 public:
  /// Readings before the first frame or after the last one are left out.
  ReadingCarrier(AbsoluteReadings readings, DeadReckoning frames, const StartPose& start);

  /// Of keyframe k, which is frame `frame`; `next` is the frame of the next keyframe, nothing of
  /// the last one. To be asked for in order, all keyframes. In order of time.
  std::vector<AbsolutePose> of(std::size_t k, std::size_t frame, std::optional<std::size_t> next);

 private:
  struct Stretch;
  struct Place;

  Place place(const Stretch& stretch, std::size_t i, std::int64_t time_ns) const;
  void take_heading(const Stretch& stretch, std::size_t i);
  void take_fix(const Stretch& stretch, std::size_t i);
  void take_until(const Stretch& stretch, std::size_t i, std::int64_t end_ns);
  void correct_heading(const MeasuredHeading& measured, double predicted_rad);

  AbsoluteReadings readings_;
  DeadReckoning frames_;
  std::size_t next_heading_ = 0;
  std::size_t next_fix_ = 0;
  double heading_rad_ = 0.0;  ///< of the last frame passed, for linearisation
  double heading_variance_ = 0.0;
  std::vector<AbsolutePose> carried_;  ///< not yet handed out, by rising keyframe
};

}  // namespace fathom
