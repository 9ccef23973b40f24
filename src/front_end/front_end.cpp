#include "fathom/front_end/front_end.hpp"

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

FrontEnd::FrontEnd(const FrameSource& source, PairRegistrar& registrar,
                   const FrontEndOptions& options)
    : source_(source), registrar_(registrar), options_(options) {
  if (!source.has_odometry()) {
    throw InputError("the data set has no dead reckoning; visual odometry can make it");
  }
}

std::optional<Keyframe> FrontEnd::next_keyframe() {
  const auto separation = static_cast<std::size_t>(options_.separation_frames);
  UncertainPose since;  // the last keyframe
  while (frames_.size() < source_.size()) {
    const std::size_t frame = frames_.size();
    const FrameInfo& info = source_.info(frame);
    if (frame > 0) since = compose(since, *info.motion);
    const bool is_keyframe = frame % separation == 0;
    if (!is_keyframe) {
      frames_.push_back({info.time_ns, keyframes_.size() - 1, since.mean});
      continue;
    }
    Keyframe keyframe{keyframes_.size(), frame, info.time_ns, std::nullopt};
    if (frame > 0) {
      keyframe.step = RelativePose::from_covariance(keyframe.index - 1, keyframe.index, since.mean,
                                                    since.covariance);
    }
    frames_.push_back({info.time_ns, keyframe.index, Pose{}});
    keyframes_.push_back(keyframe);
    announce_next_keyframe();
    return keyframe;
  }
  return std::nullopt;
}

MeasuredFrame FrontEnd::measured(std::size_t frame) const {
  return {frame, source_.info(frame).altitude_m};
}

// The next keyframe is registered with this one if its step is no longer than the reach; only then
// is it sure that its picture is needed, if the pair is not known. Visual odometry looks ahead
// itself.
void FrontEnd::announce_next_keyframe() const {
  if (source_.is_visual_odometry()) return;
  const std::size_t frame = keyframes_.back().frame;
  const std::size_t next = frame + static_cast<std::size_t>(options_.separation_frames);
  if (next >= source_.size()) return;
  Pose step;
  for (std::size_t i = frame + 1; i <= next; ++i)
    step = compose(step, source_.info(i).motion->mean);
  if (step.position().norm() > options_.max_distance_m) return;
  registrar_.announce(measured(frame), measured(next));
}

std::vector<std::size_t> FrontEnd::candidates(const TrajectoryView& trajectory) const {
  const std::size_t newest = keyframes_.size() - 1;
  const Eigen::Vector2d position = trajectory.pose(newest).position();
  // With a keyframe every frame visual odometry's step is that very registration.
  const bool step_is_registration =
      source_.is_visual_odometry() && options_.separation_frames == 1 && newest > 0;
  const std::size_t end = step_is_registration ? newest - 1 : newest;
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < end; ++k) {
    if ((trajectory.pose(k).position() - position).norm() <= options_.max_distance_m) {
      near.push_back(k);
    }
  }
  return near;
}

std::vector<RelativePose> FrontEnd::register_newest(const TrajectoryView& trajectory) {
  const std::size_t newest = keyframes_.size() - 1;
  const std::vector<std::size_t> near = candidates(trajectory);
  std::vector<MeasuredFrame> from;
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
  return registrations;
}

}  // namespace fathom
