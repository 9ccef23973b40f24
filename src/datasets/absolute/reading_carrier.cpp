#include "fathom/datasets/reading_carrier.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace fathom {

// The frames from a keyframe to the next one, or to the end.
struct ReadingCarrier::Stretch {
  std::size_t keyframe = 0;
  std::vector<DeadReckonedFrame> frames;  // the keyframe's is the first
  std::vector<UncertainPose> since;       // of each, from the keyframe on
  /// The first frame behind the last hole, from which readings go to the next keyframe.
  std::size_t behind_hole = std::numeric_limits<std::size_t>::max();

  // From `share` of the motion to frame i + 1 on.
  UncertainPose to_next_keyframe(std::size_t i, double share) const {
    std::vector<UncertainPose> parts{part_of(frames[i + 1].motion, share, 1.0)};
    for (std::size_t j = i + 2; j < frames.size(); ++j) parts.push_back(frames[j].motion);
    return compose_chain(parts);
  }
};

// A reading's: its keyframe, the motion from there, and the heading of the body as predicted.
struct ReadingCarrier::Place {
  std::size_t keyframe = 0;
  UncertainPose motion;
  double heading_rad = 0.0;
};

ReadingCarrier::ReadingCarrier(AbsoluteReadings readings, ReckonedFrames frames,
                               const StartPose& start)
    : readings_(std::move(readings)),
      frames_(std::move(frames)),
      heading_rad_(start.pose.theta),
      heading_variance_(start.covariance(2, 2)) {}

ReadingCarrier::Place ReadingCarrier::place(const Stretch& stretch, std::size_t i,
                                            std::int64_t time_ns) const {
  const DeadReckonedFrame& before = stretch.frames[i];
  if (time_ns == before.time_ns && i < stretch.behind_hole) {
    return {stretch.keyframe, stretch.since[i], heading_rad_};
  }
  const DeadReckonedFrame& after = stretch.frames[i + 1];
  const double share = static_cast<double>(time_ns - before.time_ns) /
                       static_cast<double>(after.time_ns - before.time_ns);
  const double heading_rad = heading_rad_ + share * after.motion.mean.theta;
  if (i >= stretch.behind_hole) {
    return {stretch.keyframe + 1, inverse(stretch.to_next_keyframe(i, share)), heading_rad};
  }
  return {stretch.keyframe, compose(stretch.since[i], part_of(after.motion, 0.0, share)),
          heading_rad};
}

// A Kalman filter of the heading alone.
void ReadingCarrier::correct_heading(const MeasuredHeading& measured, double predicted_rad) {
  const double gain =
      heading_variance_ / (heading_variance_ + measured.sigma_rad * measured.sigma_rad);
  heading_rad_ += gain * wrap_angle(measured.heading_rad - predicted_rad);
  heading_variance_ *= 1.0 - gain;
}

void ReadingCarrier::take_heading(const Stretch& stretch, std::size_t i) {
  const MeasuredHeading& reading = readings_.headings[next_heading_++];
  const Place at = place(stretch, i, reading.time_ns);
  carried_.push_back(heading_after(at.keyframe, reading.heading_rad, reading.sigma_rad, at.motion));
  correct_heading(reading, at.heading_rad);
}

void ReadingCarrier::take_fix(const Stretch& stretch, std::size_t i) {
  const PositionFix& fix = readings_.fixes[next_fix_++];
  const Place at = place(stretch, i, fix.time_ns);
  carried_.push_back(fix_of_point(at.keyframe, fix.position_m, fix.covariance, at.motion,
                                  readings_.lever_m, at.heading_rad - at.motion.mean.theta));
}

// Those between frame i and `end_ns`, which is not included.
void ReadingCarrier::take_until(const Stretch& stretch, std::size_t i, std::int64_t end_ns) {
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  const std::vector<MeasuredHeading>& headings = readings_.headings;
  const std::vector<PositionFix>& fixes = readings_.fixes;
  while (true) {
    const std::int64_t heading_ns =
        next_heading_ < headings.size() ? headings[next_heading_].time_ns : kNever;
    const std::int64_t fix_ns = next_fix_ < fixes.size() ? fixes[next_fix_].time_ns : kNever;
    if (std::min(heading_ns, fix_ns) >= end_ns) return;
    if (heading_ns <= fix_ns) {
      take_heading(stretch, i);
    } else {
      take_fix(stretch, i);
    }
  }
}

std::vector<AbsolutePose> ReadingCarrier::of(std::size_t k, std::size_t frame,
                                             std::optional<std::size_t> next) {
  if (readings_.is_empty()) return {};
  Stretch stretch{k, {frames_.frame(frame)}, {UncertainPose{}}};
  if (frame == 0) {
    const auto is_early = [&](const auto& reading) {
      return reading.time_ns < stretch.frames[0].time_ns;
    };
    std::erase_if(readings_.headings, is_early);
    std::erase_if(readings_.fixes, is_early);
  }
  for (std::size_t i = frame + 1; i <= next.value_or(frames_.size - 1); ++i) {
    stretch.frames.push_back(frames_.frame(i));
    const DeadReckonedFrame& last = stretch.frames.back();
    stretch.since.push_back(compose(stretch.since.back(), last.motion));
    if (last.is_hole && next && i < *next) stretch.behind_hole = i - frame;
  }
  for (std::size_t i = 0; i + 1 < stretch.frames.size(); ++i) {
    const DeadReckonedFrame& after = stretch.frames[i + 1];
    take_until(stretch, i, after.time_ns);
    heading_rad_ = wrap_angle(heading_rad_ + after.motion.mean.theta);
    heading_variance_ += after.motion.covariance(2, 2);
  }
  if (!next) take_until(stretch, stretch.frames.size() - 1, stretch.frames.back().time_ns + 1);
  const auto later = std::ranges::partition_point(
      carried_, [k](const AbsolutePose& measured) { return measured.keyframe <= k; });
  std::vector<AbsolutePose> own(carried_.begin(), later);
  carried_.erase(carried_.begin(), later);
  return own;
}

}  // namespace fathom
