#include "fathom/harness/result.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/geometry/covariance.hpp"
#include "fathom/harness/recording_facts.hpp"

namespace fathom {
namespace {

LoopUse use_of(LoopFate fate) {
  switch (fate) {
    case LoopFate::used:
      return LoopUse::used;
    case LoopFate::rejected:
      return LoopUse::rejected;
    case LoopFate::lost:
      break;
  }
  return LoopUse::lost;
}

std::vector<JudgedLoop> judged_loops(const Recording& recording, const Replay& replay) {
  std::vector<JudgedLoop> loops;
  loops.reserve(replay.loops.size());
  for (std::size_t j = 0; j < replay.loops.size(); ++j) {
    const LoopDecision& loop = replay.loops[j];
    JudgedLoop judged{loop.from,   loop.to, use_of(loop.fate), std::nullopt, replay.loop_weights[j],
                      std::nullopt};
    if (loop.nis && std::isfinite(*loop.nis)) judged.nis = loop.nis;
    if (!recording.is_false_loop.empty()) judged.is_false = recording.is_false_loop[j];
    loops.push_back(judged);
  }
  return loops;
}

ReplayFacts replay_facts(const Recording& recording, const Replay& replay,
                         const ReplayOptions& options) {
  ReplayFacts facts;
  facts.loops = judged_loops(recording, replay);
  facts.chi2_initial = options.start.empty() ? chi2(recording.log, recording.log.odometry())
                                             : chi2(recording.log, options.start);
  facts.chi2_used = replay.cost_used;
  facts.iterations = replay.iterations;
  facts.gradient_norm = replay.gradient_norm;
  facts.is_local_minimum = replay.is_local_minimum;
  facts.update_ms = replay.update_ms;
  facts.add_ms = replay.add_ms;
  facts.total_ms = replay.total_ms;
  facts.cpu_ms = replay.cpu_ms;
  if (replay.covariances) facts.covariance_ms = replay.covariance_ms;
  facts.memory_bytes = replay.memory_bytes;
  return facts;
}

// An estimate below the optimum that is known has found a better minimum, or rounded otherwise: its
// bottom is the optimum then.
std::optional<double> least_known(std::optional<double> chi2_optimum, const MeasurementLog& log,
                                  const std::vector<Pose>& estimate,
                                  const EstimatorRegistry& registry) {
  if (!chi2_optimum || !(chi2(log, estimate) < *chi2_optimum)) return chi2_optimum;
  const auto below = batch_optimum(log, registry, estimate);
  return below ? std::min(below->chi2, *chi2_optimum) : chi2_optimum;
}

// What is known of an estimate of the keyframes without whose it is.
RunFacts facts_of(const Recording& recording, const std::vector<Pose>& estimate,
                  const MetricOptions& options) {
  RunFacts facts{.log = recording.log, .estimate = estimate, .options = options};
  if (recording.ground_truth) facts.ground_truth = *recording.ground_truth;
  return facts;
}

}  // namespace

MetricOptions metric_options(const Configuration& configuration) {
  return {.alignment = configuration.alignment,
          .rpe_keyframes = configuration.study.rpe_keyframes,
          .rpe_distances_m = configuration.study.rpe_distances_m,
          .min_overlap = configuration.study.min_overlap};
}

std::optional<double> Result::metric(const std::string& name) const {
  const auto found = metrics.find(name);
  return found == metrics.end() ? std::nullopt : std::optional(found->second);
}

Result evaluate(const Recording& recording, const EstimatorConfiguration& estimator,
                const EstimatorRegistry& registry, const JudgeOptions& judging,
                const ReplayOptions& options) {
  Result result;
  result.estimator = estimator;
  result.mode = options.mode;
  result.options = judging.metrics;
  result.replay = replay(recording.log, registry.find(estimator.type), estimator.values, options);
  const std::vector<Pose>& estimate = result.replay.trajectory;
  RunFacts facts = facts_of(recording, estimate, judging.metrics);
  if (!recording.frames.empty()) {
    facts.registrations_tried = recording.registrations_tried;
    facts.registrations_left_out = recording.registrations_left_out;
  }
  const RecordingFacts shared = judging.facts != nullptr ? *judging.facts : run_facts(recording);
  if (shared.true_overlaps) facts.true_overlaps = &*shared.true_overlaps;
  facts.chi2_optimum = least_known(shared.chi2_optimum, recording.log, estimate, registry);
  if (result.replay.covariances) facts.covariances = *result.replay.covariances;
  facts.replay = replay_facts(recording, result.replay, options);
  JudgedRun judged = judge(std::move(facts));
  result.metrics = metric_values(judged);
  result.accuracy = judged.accuracy;
  result.consistency = std::move(judged.consistency);
  return result;
}

DeadReckoning judged_dead_reckoning(const Recording& recording, const MetricOptions& options) {
  DeadReckoning result;
  const MeasurementLog& log = recording.log;
  UncertainPose pose{log.origin()};
  result.covariances.push_back(pose.covariance);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const RelativePose step = log.arrival(k).step.forward();
    pose = compose(pose, UncertainPose{step.motion, step.covariance()});
    result.covariances.push_back(pose.covariance);
  }
  const std::vector<Pose> odometry = log.odometry();
  RunFacts facts = facts_of(recording, odometry, options);
  facts.covariances = result.covariances;
  const JudgedRun judged = judge(std::move(facts));
  result.metrics = metric_values(judged);
  result.consistency = judged.consistency;
  return result;
}

std::map<std::string, double> dead_reckoning_metrics(const Recording& recording,
                                                     const MetricOptions& options) {
  return judged_dead_reckoning(recording, options).metrics;
}

}  // namespace fathom
