#include "fathom/front_end/front_end.hpp"

#include <algorithm>
#include <memory>
#include <utility>

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/covariance.hpp"
#include "motion_chain.hpp"

namespace fathom {

namespace {

Spread spread(std::vector<double>& values) {
  std::ranges::sort(values);
  return {values.front(), values[values.size() / 2], values.back()};
}

}  // namespace

FrontEnd::FrontEnd(const FrameSource& source, PairRegistrar& registrar,
                   const FrontEndOptions& options, const EstimatedSigmas& sigmas)
    : source_(source),
      registrar_(registrar),
      options_(options),
      sigmas_(sigmas),
      search_(source.camera(), options.candidates),
      schedule_(source, options.keyframes) {
  if (!source.has_odometry()) {
    throw InputError("the data set has no dead reckoning; visual odometry can make it");
  }
}

// The paper's section 2: dead reckoning is composed frame by frame, some become keyframes;
// register_newest() then registers them.
std::optional<Keyframe> FrontEnd::next_keyframe() {
  const std::size_t next = schedule_.frame(keyframes_.size()).value_or(source_.size());
  MotionChain since;  // the last keyframe
  bool over_hole = false;
  while (frames_.size() < source_.size()) {
    const std::size_t frame = frames_.size();
    const FrameInfo& info = source_.info(frame);
    if (frame > 0) since.append(info);
    over_hole = over_hole || info.is_hole;
    if (frame == next) return add_keyframe(frame, info, since.motion(), over_hole);
    frames_.push_back({info.time_ns, keyframes_.size() - 1, since.motion().mean});
  }
  return std::nullopt;
}

Keyframe FrontEnd::add_keyframe(std::size_t frame, const FrameInfo& info,
                                const UncertainPose& since, bool over_hole) {
  Keyframe keyframe{keyframes_.size(), frame, info.time_ns, std::nullopt};
  if (frame > 0) {
    keyframe.step = RelativePose::from_covariance(keyframe.index - 1, keyframe.index, since.mean,
                                                  since.covariance);
    keyframe.step->is_hole = over_hole;
  }
  frames_.push_back({info.time_ns, keyframe.index, Pose{}});
  keyframes_.push_back(keyframe);
  stances_.push_back(info.stance());
  if (over_hole) holes_.push_back(keyframe.index);
  announce_next_keyframes();
  return keyframe;
}

MeasuredFrame FrontEnd::measured(std::size_t frame) const {
  return MeasuredFrame::of(source_, frame);
}

// A keyframe is registered with the one before if its step makes it a candidate; only then is it
// sure that its picture is needed, if the pair is not known. Visual odometry looks ahead itself.
void FrontEnd::announce_next_keyframes() {
  if (source_.is_visual_odometry()) return;
  std::size_t frame = keyframes_.back().frame;
  for (std::size_t n = 0; n < PairRegistrar::look_ahead(); ++n) {
    const auto next = schedule_.frame(keyframes_.size() + n);
    if (!next) return;
    Pose step;
    for (std::size_t i = frame + 1; i <= *next; ++i)
      step = compose(step, source_.info(i).motion->mean);
    const MeasuredFrame from = measured(frame);
    const MeasuredFrame to = measured(*next);
    if (search_.accepts(step, from.stance(), to.stance())) registrar_.announce(from, to);
    frame = *next;
  }
}

Candidates FrontEnd::candidates(const TrajectoryView& trajectory) {
  const std::size_t newest = keyframes_.size() - 1;
  // From one frame to the next visual odometry's step is that very registration.
  const bool step_is_registration = source_.is_visual_odometry() && newest > 0 &&
                                    keyframes_[newest].frame == keyframes_[newest - 1].frame + 1;
  return search_.find(trajectory, stances_, step_is_registration ? newest - 1 : newest, holes_);
}

// Loop candidates by the estimate, each registered with the newest keyframe (figure 2); what is
// found is a measurement.
std::vector<RelativePose> FrontEnd::register_newest(const TrajectoryView& trajectory) {
  const Candidates near = candidates(trajectory);
  if (near.asked_covariances) asked_covariances_.push_back(keyframes_.size() - 1);
  std::vector<RelativePose> registrations = registered(near);
  const std::vector<RelativePose> others = registered(search_.over_holes(registrations));
  registrations.insert(registrations.end(), others.begin(), others.end());
  std::ranges::sort(registrations, {}, &RelativePose::from);
  search_.note(registrations);
  return registrations;
}

std::vector<RelativePose> FrontEnd::registered(const Candidates& candidates) {
  const std::size_t newest = keyframes_.size() - 1;
  left_out_ += candidates.left_out;
  if (candidates.keyframes.empty()) return {};
  std::vector<MeasuredFrame> from;
  from.reserve(candidates.keyframes.size());
  for (const std::size_t k : candidates.keyframes) from.push_back(measured(keyframes_[k].frame));
  const auto results = registrar_.of_all(from, measured(keyframes_[newest].frame));
  std::vector<RelativePose> registrations;
  for (std::size_t c = 0; c < results.size(); ++c) {
    if (!results[c].found) {
      most_refused_inliers_ = std::max(most_refused_inliers_, results[c].inliers);
      continue;
    }
    const PairRegistration told =
        sigmas_.told(results[c], from[c], measured(keyframes_[newest].frame));
    registrations.push_back(RelativePose::from_covariance(candidates.keyframes[c], newest,
                                                          told.motion, told.covariance));
    registrations.back().inliers = told.inliers;
    const bool is_estimated = options_.registration.covariance.is_estimated() && sigmas_.is_empty();
    if (told.shared.is_shared() || is_estimated) {
      registrations.back().shared = std::make_shared<const SharedErrors>(told.shared);
    }
  }
  tried_ += candidates.keyframes.size();
  found_ += registrations.size();
  return registrations;
}

FrontEndInMetres FrontEnd::in_metres() const {
  KeyframeLengths lengths;
  for (const Stance& stance : stances_) lengths.altitudes_m.push_back(stance.altitude_m);
  for (std::size_t k = 1; k < keyframes_.size(); ++k) {
    lengths.steps_m.push_back(keyframes_[k].step->motion.position().norm());
    lengths.separation_frames.push_back(
        static_cast<double>(keyframes_[k].frame - keyframes_[k - 1].frame));
  }
  return fathom::in_metres(options_, source_.camera(), std::move(lengths));
}

FrontEndInMetres in_metres(const FrontEndOptions& options, const Camera& camera,
                           KeyframeLengths keyframes) {
  const CandidateSearch search(camera, options.candidates);
  std::vector<double> errors_m;
  std::vector<double> reaches_m;
  for (const double altitude_m : keyframes.altitudes_m) {
    errors_m.push_back(options.registration.ransac.max_error_on_floor(
        metres_per_pixel(camera.model(), altitude_m)));
    reaches_m.push_back(search.reach_m(altitude_m, altitude_m));
  }
  return {spread(errors_m), spread(reaches_m), spread(keyframes.steps_m),
          spread(keyframes.separation_frames)};
}

}  // namespace fathom
