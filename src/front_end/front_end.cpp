#include "fathom/front_end/front_end.hpp"

#include <opencv2/core/utility.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/front_end/pair_seed.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

FrontEnd::FrontEnd(const FrameSource& source, FeatureStore& features,
                   const FrontEndOptions& options, std::uint64_t seed)
    : source_(source), store_(features), options_(options), seed_(seed) {
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
    features_.push_back(store_.of(frame));
    keyframes_.push_back(keyframe);
    store_.announce(frame + separation);
    return keyframe;
  }
  return std::nullopt;
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
  std::vector<Registration> results(near.size());
  // Each pair has its own seed, so the order of execution does not matter.
  cv::parallel_for_(cv::Range(0, static_cast<int>(near.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      const auto c = static_cast<std::size_t>(i);
      results[c] =
          register_pair(*features_[near[c]], *features_[newest], options_.registration,
                        pair_seed(seed_, keyframes_[near[c]].frame, keyframes_[newest].frame));
    }
  });
  std::vector<RelativePose> registrations;
  for (std::size_t c = 0; c < near.size(); ++c) {
    if (!results[c].found) continue;
    registrations.push_back(
        RelativePose::from_covariance(near[c], newest, results[c].motion, results[c].covariance));
    registrations.back().inliers = static_cast<int>(results[c].inliers.size());
  }
  tried_ += near.size();
  found_ += registrations.size();
  return registrations;
}

}  // namespace fathom
