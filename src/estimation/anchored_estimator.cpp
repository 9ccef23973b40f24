#include <algorithm>
#include <optional>
#include <utility>

#include "fathom/estimation/precision.hpp"
#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// From node 0 at the start's pose to keyframe 0, which is there but for its uncertainty.
RelativePose step_to_keyframe_0(const StartPose& start) {
  RelativePose step;
  step.from = 0;
  step.to = 1;
  step.is_hole = start.is_free;
  if (!start.is_free) step.information = start.measurement().information;
  return step;
}

EstimatorSetup at_zero(EstimatorSetup setup) {
  setup.start.pose.x = 0.0;
  setup.start.pose.y = 0.0;
  return setup;
}

}  // namespace

bool is_open_hole(const RelativePose& step) {
  constexpr double kLinearTurnRad = 0.5;
  return step.is_hole && step.covariance()(2, 2) > kLinearTurnRad * kLinearTurnRad;
}

AnchoredEstimator::AnchoredEstimator(const EstimatorSetup& setup, const MakeRelative& make)
    : relative_(make(at_zero(setup))),
      node_0_(setup.start.pose),
      is_batch_(setup.mode == SolveMode::batch),
      is_frame_placed_(!is_batch_ || !setup.start.is_free) {
  stretches_.add_node(false);
  if (setup.start.is_fixed()) return;
  stretches_.add_node(false);
  shift_ = 1;
  relative_->add_keyframe(step_to_keyframe_0(setup.start));
}

RelativePose AnchoredEstimator::shifted(RelativePose z) const {
  z.from += shift_;
  z.to += shift_;
  return z;
}

RelativePose AnchoredEstimator::from_node_0(const AbsolutePose& z) const {
  RelativePose loop;
  loop.from = 0;
  loop.to = z.keyframe + shift_;
  loop.motion = between(node_0_, z.pose);
  loop.information = z.information;
  return loop;
}

// Without information, or of a keyframe that is held, it has no part in any estimate.
bool AnchoredEstimator::says_something(const AbsolutePose& z) const {
  return z.keyframe + shift_ > 0 && !z.information.isZero(0.0);
}

void AnchoredEstimator::add_keyframe(const RelativePose& step) {
  if (!is_batch_) {
    if (step.is_hole) holes_.push_back(relative_->size());
    stretches_.add_node(is_open_hole(step));
  }
  relative_->add_keyframe(shifted(step));
}

Bridge AnchoredEstimator::bridge_of(std::size_t hole, const RelativePose& loop) const {
  Bridge bridge{hole, std::nullopt, {}, stretches_.held_by(hole), holes_};
  const Pose from = relative_->pose(loop.from);
  const Pose to = relative_->pose(loop.to);
  if (is_positive_definite(loop.information)) {
    bridge.loop = loop;
    bridge.motion = bridge.moves[loop.to]
                        ? compose(compose(from, loop.motion), inverse(to))
                        : compose(compose(to, inverse(loop.motion)), inverse(from));
  } else if (loop.information.topLeftCorner<2, 2>().isZero(0.0)) {
    // A heading: the turn about the keyframe behind the hole.
    const Pose about = relative_->pose(hole);
    const double turn = from.theta + loop.motion.theta - to.theta;
    const Pose turned{about.x, about.y, about.theta + turn};
    bridge.motion = compose(turned, inverse(about));
  }
  return bridge;
}

// Of several holes that a loop crosses the last one is bridged. A hole that a heading or a fix is
// measured behind is open no more: that measurement is the first knowledge of it.
std::optional<LoopDecision> AnchoredEstimator::bridge_by(const RelativePose& loop) {
  const auto hole = stretches_.open_hole(loop.from, loop.to);
  if (!hole || !is_finite(loop.motion)) return std::nullopt;
  const Bridge bridge = bridge_of(*hole, loop);
  const auto decision = relative_->bridge(bridge);
  if (!bridge.loop) {
    stretches_.keep(loop.from, loop.to);
  } else if (!decision || decision->fate == LoopFate::used) {
    stretches_.replace(*hole, loop.from, loop.to);
  }
  return decision;
}

UpdateReport AnchoredEstimator::close_loops(std::span<const RelativePose> loops) {
  if (holes_.empty() || !stretches_.has_open()) return relative_->close_loops(loops);
  std::vector<std::optional<LoopDecision>> bridged;
  std::vector<RelativePose> left;
  for (const RelativePose& loop : loops) {
    const std::optional<LoopDecision> decision = bridge_by(loop.forward());
    if (!decision) left.push_back(loop);
    bridged.push_back(decision);
  }
  UpdateReport report = left.empty() ? UpdateReport{} : relative_->close_loops(left);
  const std::vector<LoopDecision> decisions = std::exchange(report.loops, {});
  std::size_t next = 0;
  for (std::size_t j = 0; j < loops.size(); ++j) {
    const LoopDecision& decision = bridged[j] ? *bridged[j] : decisions.at(next++);
    report.loops.push_back({loops[j].from, loops[j].to, decision.fate, decision.nis});
  }
  return report;
}

// Nothing that was passed on says yet where it is.
void AnchoredEstimator::place_frame(std::span<const AbsolutePose> absolute) {
  for (const AbsolutePose& z : absolute) {
    if (is_frame_placed_) return;
    if (z.information.topLeftCorner<2, 2>().isZero(0.0) || !is_finite(z.pose)) continue;
    node_0_.x = z.pose.x;
    node_0_.y = z.pose.y;
    is_frame_placed_ = true;
  }
}

bool AnchoredEstimator::are_resolved_in_world(const Measurements& measurements) const {
  return are_resolved(*this, measurements.registrations) &&
         std::ranges::all_of(measurements.absolute, [&](const AbsolutePose& z) {
           return !says_something(z) || is_resolved(from_node_0(z), node_0_, pose(z.keyframe));
         });
}

void AnchoredEstimator::note_given(const Measurements& measurements, bool are_refused) {
  std::optional<double> weight;
  if (are_refused) weight = 0.0;
  given_.insert(given_.end(), measurements.registrations.size(), {false, weight});
  for (const AbsolutePose& z : measurements.absolute) {
    given_.push_back({true, says_something(z) ? weight : 1.0});
  }
}

UpdateReport AnchoredEstimator::refused(const Measurements& measurements) const {
  UpdateReport report;
  report.outcome = Outcome::numerical_failure;
  for (const RelativePose& z : measurements.registrations) {
    report.loops.push_back({z.from, z.to, LoopFate::lost, std::nullopt});
  }
  for (const AbsolutePose& z : measurements.absolute) {
    const LoopFate fate = says_something(z) ? LoopFate::lost : LoopFate::used;
    report.absolute.push_back({z.keyframe, fate, std::nullopt});
  }
  return report;
}

UpdateReport AnchoredEstimator::update(const Measurements& measurements) {
  place_frame(measurements.absolute);
  const bool are_refused = !are_resolved_in_world(measurements);
  note_given(measurements, are_refused);
  if (are_refused) return refused(measurements);
  // The usual case: nothing to write anew.
  if (shift_ == 0 && measurements.absolute.empty()) {
    return close_loops(measurements.registrations);
  }
  return passed_on(measurements);
}

UpdateReport AnchoredEstimator::passed_on(const Measurements& measurements) {
  std::vector<RelativePose> loops;
  for (const RelativePose& z : measurements.registrations) loops.push_back(shifted(z));
  for (const AbsolutePose& z : measurements.absolute) {
    if (says_something(z)) loops.push_back(from_node_0(z));
  }
  UpdateReport report = loops.empty() ? UpdateReport{} : close_loops(loops);
  const std::vector<LoopDecision> decisions = std::exchange(report.loops, {});
  std::size_t next = 0;
  for (const RelativePose& z : measurements.registrations) {
    const LoopDecision& decision = decisions.at(next++);
    report.loops.push_back({z.from, z.to, decision.fate, decision.nis});
  }
  for (const AbsolutePose& z : measurements.absolute) {
    report.absolute.push_back({z.keyframe, LoopFate::used, std::nullopt});
    if (!says_something(z)) continue;
    report.absolute.back().fate = decisions.at(next).fate;
    report.absolute.back().nis = decisions.at(next++).nis;
  }
  return report;
}

UpdateReport AnchoredEstimator::finish(std::span<const Pose> start) {
  if (start.empty()) return relative_->finish();
  std::vector<Pose> nodes;
  if (shift_ > 0) nodes.push_back({0.0, 0.0, node_0_.theta});
  for (const Pose& X : start) nodes.push_back({X.x - node_0_.x, X.y - node_0_.y, X.theta});
  return relative_->finish(nodes);
}

MovedPoses AnchoredEstimator::moved_since(std::uint64_t revision) const {
  MovedPoses moved = relative_->moved_since(revision);
  if (shift_ == 0 || !moved.keyframes) return moved;
  std::erase(*moved.keyframes, 0);
  for (std::size_t& k : *moved.keyframes) --k;
  return moved;
}

std::optional<std::vector<UncertainPose>> AnchoredEstimator::motions_to_newest() const {
  auto motions = relative_->motions_to_newest();
  if (motions && shift_ > 0) motions->erase(motions->begin());
  return motions;
}

std::optional<Eigen::MatrixXd> AnchoredEstimator::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  if (shift_ == 0) return relative_->joint_covariance(keyframes);
  std::vector<std::size_t> nodes(keyframes.begin(), keyframes.end());
  for (std::size_t& k : nodes) ++k;
  return relative_->joint_covariance(nodes);
}

// The relative estimator has one weight for each loop that it was passed.
std::vector<double> AnchoredEstimator::weights_of(bool absolute) const {
  const std::vector<double> all = relative_->loop_weights();
  if (all.empty()) return {};
  std::vector<double> weights;
  std::size_t next = 0;
  for (const Given& given : given_) {
    const double weight = given.weight ? *given.weight : all.at(next++);
    if (given.is_absolute == absolute) weights.push_back(weight);
  }
  return weights;
}

}  // namespace fathom
