#include "fathom/harness/replay.hpp"

#include <algorithm>
#include <cmath>

#include "call_timer.hpp"
#include "cost_used.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/harness/guarded_estimator.hpp"
#include "fathom/measurements/connected_guess.hpp"

namespace fathom {
namespace {

void note_decisions(const UpdateReport& report, Run& result) {
  const auto append = [](const auto& more, auto& all) {
    for (auto decision : more) {
      if (decision.nis && !std::isfinite(*decision.nis)) decision.nis.reset();
      all.push_back(decision);
    }
  };
  append(report.loops, result.loops);
  append(report.absolute, result.absolute);
}

void note(const UpdateReport& report, double elapsed_ms, Run& result) {
  result.costs.update_ms.push_back(elapsed_ms);
  result.iterations += report.iterations;
  result.gradient_norm = report.gradient_norm;
  result.is_local_minimum = report.is_local_minimum;
  result.outcome = worse(result.outcome, report.outcome);
  ++result.outcome_counts[static_cast<std::size_t>(report.outcome)];
  note_decisions(report, result);
}

// What the front end asks for where the estimator's own uncertainty selects the loop candidates.
void ask_for_candidates(const Estimator& estimator, Run& result) {
  const CallTimer timer(result.costs);
  estimator.motions_to_newest();
  result.costs.candidate_covariance_ms =
      result.costs.candidate_covariance_ms.value_or(0.0) + timer.stop();
}

// The duty of every back end alike: how well the newest pose is known. Its own block alone, as an
// estimator may keep what covariance() computes of all.
class NewestCovariances {
 public:
  NewestCovariances(const ReplayOptions& options, Run& result)
      : options_(options),
        result_(result),
        asks_(options.newest_covariances && options.mode == SolveMode::incremental) {}

  void ask(const Estimator& estimator) {
    if (!asks_) return;
    if (options_.memory != nullptr) options_.memory->pause();
    const auto start = CallTimer::Clock::now();
    const bool is_known = estimator.newest_covariance().has_value();
    result_.costs.newest_covariance_ms.push_back(CallTimer::milliseconds_since(start));
    if (options_.memory != nullptr) options_.memory->resume();
    if (is_known) return;
    asks_ = false;
    result_.costs.newest_covariance_ms.clear();
  }

 private:
  const ReplayOptions& options_;
  Run& result_;
  bool asks_ = false;
};

void give_measurements(const KeyframeMeasurements& arrival, Estimator& estimator,
                       const ReplayOptions& options, Run& result) {
  const Measurements measurements{arrival.registrations, arrival.absolute};
  if (measurements.is_empty()) return;
  const CallTimer timer(result.costs);
  const UpdateReport report = estimator.update(measurements);
  const double update_ms = timer.stop();
  if (options.mode == SolveMode::incremental) return note(report, update_ms, result);
  // In batch mode nothing is solved here: only the decisions count, and whether they could be
  // taken.
  if (!is_done(report.outcome)) result.outcome = worse(result.outcome, report.outcome);
  note_decisions(report, result);
}

template <class Decisions>
void lose_used(Decisions& decisions) {
  for (auto& decision : decisions) {
    if (decision.fate == LoopFate::used) decision.fate = LoopFate::lost;
  }
}

// Over a hole dead reckoning is a guess, from which a solve may end anywhere.
std::vector<Pose> guess_over_holes(const MeasurementLog& log, const ReplayOptions& options) {
  const bool is_needed = options.mode == SolveMode::batch && options.start.empty() &&
                         (log.hole_count() > 0 || log.start().is_free);
  return is_needed ? connected_guess(log) : std::vector<Pose>{};
}

void give_keyframes(const MeasurementLog& log, Estimator& estimator, const ReplayOptions& options,
                    Run& result) {
  NewestCovariances newest(options, result);
  give_measurements(log.arrival(0), estimator, options, result);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const CallTimer add_timer(result.costs);
    estimator.add_keyframe(log.arrival(k).step);
    result.costs.add_ms.push_back(add_timer.stop());
    if (std::ranges::binary_search(options.candidate_covariances, k)) {
      ask_for_candidates(estimator, result);
    }
    give_measurements(log.arrival(k), estimator, options, result);
    newest.ask(estimator);
    if (options.progress) options.progress(k + 1, log.size());
  }
  if (options.mode == SolveMode::incremental) return;
  const CallTimer timer(result.costs);
  const UpdateReport report = estimator.finish(options.start);
  const double solve_ms = timer.stop();
  note(report, solve_ms, result);
  if (is_done(report.outcome)) return;
  lose_used(result.loops);
  lose_used(result.absolute);
}

// Every weight is 1 where the estimator says nothing, and 0 of what is not used.
template <class Decisions>
std::vector<double> weights_of(std::vector<double> weights, const Decisions& decisions) {
  if (weights.empty()) weights.assign(decisions.size(), 1.0);
  for (std::size_t j = 0; j < decisions.size(); ++j) {
    if (decisions[j].fate != LoopFate::used) weights[j] = 0.0;
  }
  return weights;
}

void collect_covariances(Estimator& estimator, Run& result) {
  const auto start = CallTimer::Clock::now();
  std::vector<Eigen::Matrix3d> covariances;
  for (std::size_t k = 0; k < estimator.size(); ++k) {
    const auto covariance = estimator.covariance(k);
    if (!covariance) return;
    covariances.push_back(*covariance);
  }
  result.costs.covariance_ms = CallTimer::milliseconds_since(start);
  result.covariances = std::move(covariances);
}

// Of one group of motions with one joint covariance, of every keyframe that is in it.
void collect_motions(const Estimator& estimator, JudgedMotions& motions) {
  std::vector<std::size_t> keyframes;
  for (const auto& [from, to] : motions.pairs) keyframes.insert(keyframes.end(), {from, to});
  std::ranges::sort(keyframes);
  keyframes.erase(std::unique(keyframes.begin(), keyframes.end()), keyframes.end());
  const auto joint = estimator.joint_covariance(keyframes);
  if (!joint) return;
  const auto row_of = [&](std::size_t keyframe) {
    return 3 * (std::ranges::lower_bound(keyframes, keyframe) - keyframes.begin());
  };
  for (const auto& [from, to] : motions.pairs) {
    const auto block = [&](std::size_t row, std::size_t column) -> Eigen::Matrix3d {
      return joint->block<3, 3>(row_of(row), row_of(column));
    };
    const PairCovariance pair{block(from, from), block(to, to), block(from, to)};
    motions.covariances.push_back(
        between(estimator.pose(from), estimator.pose(to), pair).covariance);
  }
}

// After a fault no output of the estimator can be trusted.
void note_fault(const GuardedEstimator& estimator, Run& result) {
  result.fault = estimator.fault();
  result.outcome = estimator.fault_outcome();
  lose_used(result.loops);
  lose_used(result.absolute);
  result.loop_weights.assign(result.loops.size(), 0.0);
  result.absolute_weights.assign(result.absolute.size(), 0.0);
  result.covariances.reset();
  result.costs.covariance_ms.reset();
  result.costs.newest_covariance_ms.clear();
  for (JudgedMotions& motions : result.motions) motions.covariances.clear();
}

}  // namespace

Run replay(const MeasurementLog& log, const EstimatorEntry& entry, const EstimatorValues& values,
           const ReplayOptions& asked) {
  const std::vector<Pose> guess = guess_over_holes(log, asked);
  ReplayOptions options = asked;
  if (!guess.empty()) options.start = guess;
  Run result;
  // Not to be counted as the estimator's.
  result.loops.reserve(log.registration_count());
  result.absolute.reserve(log.absolute_count());
  result.costs.update_ms.reserve(log.size());
  result.costs.add_ms.reserve(log.size());
  if (options.newest_covariances) result.costs.newest_covariance_ms.reserve(log.size());
  reset_program_work();
  if (options.memory != nullptr) options.memory->start();
  GuardedEstimator estimator(entry, {log.start(), options.mode}, values);
  if (estimator.estimates_shared_errors()) result.errors = RegistrationErrors::shared;
  result.chi2_initial =
      chi2(log, options.start.empty() ? log.odometry() : options.start, result.errors);
  give_keyframes(log, estimator, options, result);
  if (options.memory != nullptr) result.costs.memory_bytes = options.memory->stop();
  if (result.costs.start_up_ms) result.costs.memory_bytes = program_work().peak_bytes;
  result.trajectory = poses_of(estimator);
  result.loop_weights = weights_of(estimator.loop_weights(), result.loops);
  result.absolute_weights = weights_of(estimator.absolute_weights(), result.absolute);
  if (options.covariances) collect_covariances(estimator, result);
  result.motions = options.motions;
  for (JudgedMotions& motions : result.motions) {
    motions.covariances.clear();
    collect_motions(estimator, motions);
  }
  result.absolute_chi2_used = absolute_cost_used(log, estimator, result);
  result.chi2_used = cost_used(log, estimator, result);
  if (!estimator.fault().empty()) note_fault(estimator, result);
  return result;
}

}  // namespace fathom
