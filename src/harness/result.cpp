#include "fathom/harness/result.hpp"

#include <algorithm>

#include "fathom/geometry/covariance.hpp"
#include "fathom/harness/isolated_replay.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/harness/run_folder.hpp"
#include "held_out_run.hpp"

namespace fathom {
namespace {

// An estimate below the optimum that is known has found a better minimum, or rounded otherwise: its
// bottom is the optimum then.
std::optional<double> least_known(std::optional<double> chi2_optimum, const MeasurementLog& log,
                                  const std::vector<Pose>& estimate,
                                  const EstimatorRegistry& registry, RegistrationErrors errors) {
  if (!chi2_optimum || !(chi2(log, estimate, errors) < *chi2_optimum)) return chi2_optimum;
  const auto below = batch_optimum(log, registry, estimate, errors);
  return below ? std::min(below->chi2, *chi2_optimum) : chi2_optimum;
}

/// Frames that have ground truth, estimated and true.
struct JudgedFrames {
  std::vector<Pose> estimate;
  std::vector<Pose> truth;
};

JudgedFrames judged_frames(const Recording& recording, const std::vector<Pose>& keyframes) {
  JudgedFrames frames;
  if (!recording.ground_truth) return frames;
  auto truth = recording.frame_ground_truth.begin();
  for (const StampedPose& frame : frame_trajectory(recording, keyframes)) {
    if (truth == recording.frame_ground_truth.end()) break;
    if (truth->time_ns != frame.time_ns) continue;
    frames.estimate.push_back(frame.pose);
    frames.truth.push_back((truth++)->pose);
  }
  return frames;
}

// What is known of an estimate of the keyframes without whose it is.
RunFacts facts_of(const Recording& recording, const MeasurementLog& log,
                  const std::vector<Pose>& estimate, const JudgedFrames& frames,
                  const MetricOptions& options) {
  RunFacts facts{.log = log, .estimate = estimate, .options = options};
  if (recording.ground_truth) facts.ground_truth = *recording.ground_truth;
  facts.frame_estimate = frames.estimate;
  facts.frame_ground_truth = frames.truth;
  return facts;
}

// The covariance of ⊖X_from ⊕ X_to. Steps are independent, so a motion is the composition of those
// between.
Eigen::Matrix3d reckoned_covariance(const MeasurementLog& log, const KeyframePair& pair) {
  const auto [first, last] = std::minmax(pair.from, pair.to);
  std::vector<UncertainPose> steps;
  for (std::size_t k = first + 1; k <= last; ++k) {
    const RelativePose step = log.arrival(k).step.forward();
    steps.push_back({step.motion, step.covariance()});
  }
  const UncertainPose motion = compose_chain(steps);
  return pair.from < pair.to ? motion.covariance : inverse(motion).covariance;
}

std::vector<JudgedMotions> dead_reckoned_motions(const Recording& recording,
                                                 const MetricOptions& options) {
  if (!recording.ground_truth) return {};
  auto groups = motions_to_judge(*recording.ground_truth, options);
  for (JudgedMotions& motions : groups) {
    for (const KeyframePair& pair : motions.pairs) {
      motions.covariances.push_back(reckoned_covariance(recording.log, pair));
    }
  }
  return groups;
}

// Dead reckoning is made without loops as it is.
std::optional<HeldOutLoops> reckoned_held_out(const Recording& recording,
                                              const std::vector<Pose>& odometry,
                                              const MetricOptions& options) {
  auto held_out = held_out_loops(recording, options);
  if (!held_out) return std::nullopt;
  held_out->estimate = odometry;
  for (const KeyframePair& pair : tested_pairs(*held_out)) {
    held_out->covariances.push_back(reckoned_covariance(recording.log, pair));
  }
  return held_out;
}

std::vector<Eigen::Matrix3d> reckoned_covariances(const MeasurementLog& log, UncertainPose pose) {
  std::vector<Eigen::Matrix3d> covariances{pose.covariance};
  for (std::size_t k = 1; k < log.size(); ++k) {
    const RelativePose step = log.arrival(k).step.forward();
    pose = compose(pose, UncertainPose{step.motion, step.covariance()});
    covariances.push_back(pose.covariance);
  }
  return covariances;
}

Run replayed(const MeasurementLog& log, const EstimatorEntry& entry, const EstimatorValues& values,
             const EvaluationOptions& options) {
  const IsolationOptions& isolation = options.isolation;
  if (!isolation.is_isolated(entry)) return replay(log, entry, values, options);
  return isolated_replay(log, entry, values, options,
                         {isolation.time_limit_s, std::int64_t{isolation.memory_limit_mib} << 20});
}

EvaluationOptions asked_of(const Recording& recording, const JudgeOptions& judging,
                           const EvaluationOptions& options) {
  EvaluationOptions asked = options;
  if (options.own_candidates) asked.candidate_covariances = recording.asked_covariances;
  if (recording.ground_truth) {
    asked.motions = motions_to_judge(*recording.ground_truth, judging.metrics);
  }
  return asked;
}

// Metrics, accuracy and consistency of a result that has its replay.
void judge_replay(Result& result, const Recording& recording, const EstimatorRegistry& registry,
                  const JudgeOptions& judging, const HeldOutLoops* held_out = nullptr) {
  const std::vector<Pose>& estimate = result.run.trajectory;
  const JudgedFrames frames = judged_frames(recording, estimate);
  RunFacts facts = facts_of(recording, recording.log, estimate, frames, judging.metrics);
  if (!recording.frames.empty()) {
    facts.registrations_tried = recording.registrations_tried;
    facts.registrations_left_out = recording.registrations_left_out;
  }
  const RecordingFacts shared = judging.facts != nullptr ? *judging.facts : run_facts(recording);
  if (shared.true_overlaps) facts.true_overlaps = &*shared.true_overlaps;
  if (shared.loop_terms) facts.loop_terms = &*shared.loop_terms;
  facts.chi2_optimum = least_known(shared.optimum(result.run.errors, recording.log), recording.log,
                                   estimate, registry, result.run.errors);
  if (result.run.covariances) facts.covariances = *result.run.covariances;
  facts.motions = result.run.motions;
  facts.run = &result.run;
  if (!recording.is_false_loop.empty()) facts.is_false_loop = &recording.is_false_loop;
  facts.held_out = held_out;
  JudgedRun judged = judge(std::move(facts));
  result.metrics = metric_values(judged);
  result.accuracy = judged.accuracy;
  result.consistency = std::move(judged.consistency);
}

}  // namespace

EvaluationOptions evaluation_options(const Configuration& configuration,
                                     const EstimatorConfiguration& estimator) {
  EvaluationOptions options;
  options.newest_covariances = configuration.study.newest_covariance;
  options.isolation = configuration.isolation;
  const CandidateReference& reference = configuration.reference;
  const bool selects = configuration.study.association == Association::own ||
                       (reference.is_contender && reference.estimator.name == estimator.name);
  const bool has_pictures = !find_data_set(configuration.dataset.type).is_graph;
  options.own_candidates = selects && has_pictures;
  return options;
}

std::optional<double> Result::metric(const std::string& name) const {
  const auto found = metrics.find(name);
  return found == metrics.end() ? std::nullopt : std::optional(found->second);
}

Result evaluate(const Recording& recording, const EstimatorConfiguration& estimator,
                const EstimatorRegistry& registry, const JudgeOptions& judging,
                const EvaluationOptions& options) {
  const EvaluationOptions asked = asked_of(recording, judging, options);
  Result result;
  result.estimator = estimator;
  result.mode = options.mode;
  result.options = judging.metrics;
  const EstimatorEntry& entry = registry.find(estimator.type);
  result.run = replayed(recording.log, entry, estimator.values, asked);
  std::optional<HeldOutLoops> held_out;
  // Who fails with all loops is not asked again.
  if (result.is_done()) {
    held_out =
        held_out_run(recording, judging.metrics, options, [&](const auto& log, const auto& of) {
          return replayed(log, entry, estimator.values, {of, options.isolation});
        });
  }
  judge_replay(result, recording, registry, judging, held_out ? &*held_out : nullptr);
  return result;
}

Result evaluate_lost(const Recording& recording, const EstimatorConfiguration& estimator,
                     const EstimatorRegistry& registry, const JudgeOptions& judging,
                     Outcome outcome, const std::string& fault) {
  Result result;
  result.estimator = estimator;
  result.options = judging.metrics;
  result.run = lost_run(recording.log, asked_of(recording, judging, {}), outcome, fault);
  judge_replay(result, recording, registry, judging);
  return result;
}

DeadReckoning judged_dead_reckoning(const Recording& recording, const MetricOptions& options) {
  DeadReckoning result;
  const MeasurementLog& log = recording.log;
  UncertainPose start{log.origin()};
  if (!log.start().is_free) start.covariance = log.start().covariance;
  result.covariances = reckoned_covariances(log, start);
  const std::vector<Pose> odometry = log.odometry();
  // Where it begins it does not know itself: it is judged from there on.
  std::optional<MeasurementLog> from_there;
  if (!log.start().is_fixed()) from_there.emplace(log).set_start(log.origin());
  const JudgedFrames frames = judged_frames(recording, odometry);
  RunFacts facts = facts_of(recording, from_there ? *from_there : log, odometry, frames, options);
  const std::vector<Eigen::Matrix3d> from_held = reckoned_covariances(log, {log.origin()});
  facts.covariances = from_held;
  const std::vector<JudgedMotions> motions = dead_reckoned_motions(recording, options);
  facts.motions = motions;
  const auto held_out = reckoned_held_out(recording, odometry, options);
  if (held_out) facts.held_out = &*held_out;
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
