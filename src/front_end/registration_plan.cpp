#include "fathom/front_end/registration_plan.hpp"

#include <numeric>

#include "fathom/front_end/candidates.hpp"
#include "fathom/front_end/keyframes.hpp"

namespace fathom {

std::size_t RegistrationPlan::all_candidates() const {
  return std::accumulate(candidates.begin(), candidates.end(), std::size_t{0});
}

RegistrationPlan plan_registrations(const FrameSource& frames, const FrontEndOptions& options) {
  KeyframeSchedule schedule(frames, options.keyframes);
  CandidateSearch search(frames.camera(), options.candidates);
  RegistrationPlan plan;
  GivenTrajectory trajectory;
  std::vector<Stance> stances;
  Pose pose;
  std::size_t frame = 0;
  while (const auto next = schedule.frame(trajectory.size())) {
    const Pose before = pose;
    const std::size_t frame_before = frame;
    for (; frame < *next; ++frame) pose = compose(pose, frames.info(frame + 1).motion->mean);
    if (trajectory.size() > 0) {
      plan.lengths.steps_m.push_back((pose.position() - before.position()).norm());
      plan.lengths.separation_frames.push_back(static_cast<double>(frame - frame_before));
    }
    trajectory.append(pose);
    plan.lengths.altitudes_m.push_back(frames.info(frame).altitude_m);
    stances.push_back(frames.info(frame).stance());
    const std::size_t newest = trajectory.size() - 1;
    const std::vector<std::size_t> found = search.find(trajectory, stances, newest).keyframes;
    plan.candidates.push_back(found.size());
    if (found.empty()) continue;
    if (found.back() + 1 == newest) ++plan.consecutive;
    const std::size_t from = schedule.frame(found.back()).value();
    plan.last_pair = {MeasuredFrame::of(frames, from), MeasuredFrame::of(frames, frame)};
  }
  return plan;
}

}  // namespace fathom
