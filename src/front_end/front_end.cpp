#include "fathom/front_end/front_end.hpp"

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

FrontEnd::FrontEnd(const FrameSource& source, PairRegistrar& registrar,
                   const FrontEndOptions& options)
    : source_(source),
      registrar_(registrar),
      options_(options),
      search_(source.camera(), options.candidates) {
  if (!source.has_odometry()) {
    throw InputError("the data set has no dead reckoning; visual odometry can make it");
  }
}

// The paper's section 2: dead reckoning is composed frame by frame, every so many frames one
// becomes a keyframe; register_newest() then registers it.
std::optional<Keyframe> FrontEnd::next_keyframe() {
  const auto separation = static_cast<std::size_t>(options_.separation_frames);
  UncertainPose since;  // the last keyframe
  while (frames_.size() < source_.size()) {
    const std::size_t frame = frames_.size();
    const FrameInfo& info = source_.info(frame);
    if (frame > 0) since = compose(since, *info.motion);
    if (frame % separation == 0) return add_keyframe(frame, info, since);
    frames_.push_back({info.time_ns, keyframes_.size() - 1, since.mean});
  }
  return std::nullopt;
}

Keyframe FrontEnd::add_keyframe(std::size_t frame, const FrameInfo& info,
                                const UncertainPose& since) {
  Keyframe keyframe{keyframes_.size(), frame, info.time_ns, std::nullopt};
  if (frame > 0) {
    keyframe.step = RelativePose::from_covariance(keyframe.index - 1, keyframe.index, since.mean,
                                                  since.covariance);
  }
  frames_.push_back({info.time_ns, keyframe.index, Pose{}});
  keyframes_.push_back(keyframe);
  altitudes_m_.push_back(info.altitude_m);
  announce_next_keyframes();
  return keyframe;
}

MeasuredFrame FrontEnd::measured(std::size_t frame) const {
  return {frame, source_.info(frame).altitude_m};
}

// A keyframe is registered with the one before if its step makes it a candidate; only then is it
// sure that its picture is needed, if the pair is not known. Visual odometry looks ahead itself.
void FrontEnd::announce_next_keyframes() const {
  if (source_.is_visual_odometry()) return;
  const auto separation = static_cast<std::size_t>(options_.separation_frames);
  std::size_t frame = keyframes_.back().frame;
  for (std::size_t n = 0; n < PairRegistrar::look_ahead(); ++n, frame += separation) {
    const std::size_t next = frame + separation;
    if (next >= source_.size()) return;
    Pose step;
    for (std::size_t i = frame + 1; i <= next; ++i)
      step = compose(step, source_.info(i).motion->mean);
    const MeasuredFrame from = measured(frame);
    const MeasuredFrame to = measured(next);
    if (search_.accepts(step, from.altitude_m, to.altitude_m)) registrar_.announce(from, to);
  }
}

Candidates FrontEnd::candidates(const TrajectoryView& trajectory) {
  const std::size_t newest = keyframes_.size() - 1;
  // With a keyframe every frame visual odometry's step is that very registration.
  const bool step_is_registration =
      source_.is_visual_odometry() && options_.separation_frames == 1 && newest > 0;
  return search_.find(trajectory, altitudes_m_, step_is_registration ? newest - 1 : newest);
}

// Loop candidates by the estimate, each registered with the newest keyframe (figure 2); what is
// found is a measurement.
std::vector<RelativePose> FrontEnd::register_newest(const TrajectoryView& trajectory) {
  const std::size_t newest = keyframes_.size() - 1;
  const auto [near, left_out] = candidates(trajectory);
  std::vector<MeasuredFrame> from;
  from.reserve(near.size());
  for (const std::size_t k : near) from.push_back(measured(keyframes_[k].frame));
  const auto results = registrar_.of_all(from, measured(keyframes_[newest].frame));
  std::vector<RelativePose> registrations;
  for (std::size_t c = 0; c < near.size(); ++c) {
    if (!results[c].found) continue;
    registrations.push_back(
        RelativePose::from_covariance(near[c], newest, results[c].motion, results[c].covariance));
    registrations.back().inliers = results[c].inliers;
  }
  tried_ += near.size();
  found_ += registrations.size();
  left_out_ += left_out;
  return registrations;
}

}  // namespace fathom
