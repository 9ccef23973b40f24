#include "fathom/front_end/registration_plan.hpp"

#include <cmath>
#include <numeric>

#include "fathom/front_end/candidates.hpp"
#include "fathom/front_end/keyframes.hpp"

namespace fathom {
namespace {

// Dead reckoning up to a keyframe: its variances of heading and its lengths add up.
struct StepSums {
  double variance = 0.0;
  double way_m = 0.0;
  std::size_t holes = 0;
};

void add_step(const FrameInfo& frame, StepSums& sum) {
  sum.holes += frame.is_hole ? 1 : 0;
  sum.variance += frame.motion->covariance(2, 2);
  sum.way_m += frame.motion->mean.position().norm();
}

// The earliest candidate of a keyframe without a hole between is the one that it knows worst.
void widen(const std::vector<StepSums>& keyframes, const std::vector<std::size_t>& candidates,
           std::optional<ReckonedLoop>& widest) {
  const StepSums& newest = keyframes.back();
  for (const std::size_t k : candidates) {
    if (keyframes[k].holes != newest.holes || k + 2 > keyframes.size() - 1) continue;
    const double sigma_rad = std::sqrt(newest.variance - keyframes[k].variance);
    if (!widest || sigma_rad > widest->sigma_rad) {
      widest = {sigma_rad, newest.way_m - keyframes[k].way_m};
    }
    return;
  }
}

}  // namespace

std::size_t RegistrationPlan::all_candidates() const {
  return std::accumulate(candidates.begin(), candidates.end(), std::size_t{0});
}

RegistrationPlan plan_registrations(const FrameSource& frames, const FrontEndOptions& options) {
  KeyframeSchedule schedule(frames, options.keyframes);
  CandidateSearch search(frames.camera(), options.candidates);
  RegistrationPlan plan;
  GivenTrajectory trajectory;
  std::vector<Stance> stances;
  std::vector<StepSums> reckoned;
  StepSums sum;
  Pose pose;
  std::size_t frame = 0;
  while (const auto next = schedule.frame(trajectory.size())) {
    const Pose before = pose;
    const std::size_t frame_before = frame;
    for (; frame < *next; ++frame) {
      pose = compose(pose, frames.info(frame + 1).motion->mean);
      add_step(frames.info(frame + 1), sum);
    }
    if (trajectory.size() > 0) {
      plan.lengths.steps_m.push_back((pose.position() - before.position()).norm());
      plan.lengths.separation_frames.push_back(static_cast<double>(frame - frame_before));
    }
    trajectory.append(pose);
    reckoned.push_back(sum);
    plan.lengths.altitudes_m.push_back(frames.info(frame).altitude_m);
    stances.push_back(frames.info(frame).stance());
    const std::size_t newest = trajectory.size() - 1;
    const std::vector<std::size_t> found = search.find(trajectory, stances, newest).keyframes;
    plan.candidates.push_back(found.size());
    if (found.empty()) continue;
    if (found.back() + 1 == newest) ++plan.consecutive;
    widen(reckoned, found, plan.widest);
    const std::size_t from = schedule.frame(found.back()).value();
    plan.last_pair = {MeasuredFrame::of(frames, from), MeasuredFrame::of(frames, frame)};
  }
  return plan;
}

}  // namespace fathom
