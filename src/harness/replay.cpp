#include "fathom/harness/replay.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "fathom/core/workers.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/harness/guarded_estimator.hpp"

namespace fathom {
namespace {

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Wall and CPU time of one call of the estimator, added to the totals.
class CallTimer {
 public:
  explicit CallTimer(Replay& result) : result_(result) {}

  double stop() const {
    const double elapsed_ms = milliseconds_since(start_);
    result_.total_ms += elapsed_ms;
    result_.cpu_ms += 1e3 * (thread_processor_seconds() - cpu_start_s_);
    return elapsed_ms;
  }

 private:
  Replay& result_;
  double cpu_start_s_ = thread_processor_seconds();
  Clock::time_point start_ = Clock::now();
};

void note(const UpdateReport& report, double elapsed_ms, Replay& result) {
  result.update_ms.push_back(elapsed_ms);
  result.iterations += report.iterations;
  result.gradient_norm = report.gradient_norm;
  result.is_local_minimum = report.is_local_minimum;
  result.outcome = worse(result.outcome, report.outcome);
  ++result.outcome_counts[static_cast<std::size_t>(report.outcome)];
  result.loops.insert(result.loops.end(), report.loops.begin(), report.loops.end());
}

// What the front end asks for where the estimator's own uncertainty selects the loop candidates.
void ask_for_candidates(const Estimator& estimator, Replay& result) {
  const CallTimer timer(result);
  estimator.motions_to_newest();
  result.candidate_covariance_ms = result.candidate_covariance_ms.value_or(0.0) + timer.stop();
}

// The duty of every back end alike: how well the newest pose is known. Its own block alone, as an
// estimator may keep what covariance() computes of all.
class NewestCovariances {
 public:
  NewestCovariances(const ReplayOptions& options, Replay& result)
      : options_(options),
        result_(result),
        asks_(options.newest_covariances && options.mode == SolveMode::incremental) {}

  void ask(const Estimator& estimator) {
    if (!asks_) return;
    if (options_.memory != nullptr) options_.memory->pause();
    const auto start = Clock::now();
    const bool is_known = estimator.newest_covariance().has_value();
    result_.newest_covariance_ms.push_back(milliseconds_since(start));
    if (options_.memory != nullptr) options_.memory->resume();
    if (is_known) return;
    asks_ = false;
    result_.newest_covariance_ms.clear();
  }

 private:
  const ReplayOptions& options_;
  Replay& result_;
  bool asks_ = false;
};

void give_keyframes(const MeasurementLog& log, Estimator& estimator, const ReplayOptions& options,
                    Replay& result) {
  const bool batch = options.mode == SolveMode::batch;
  NewestCovariances newest(options, result);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    const CallTimer add_timer(result);
    estimator.add_keyframe(arrival.step);
    result.add_ms.push_back(add_timer.stop());
    if (options.candidate_covariances) ask_for_candidates(estimator, result);
    if (!arrival.registrations.empty()) {
      const CallTimer update_timer(result);
      const UpdateReport report = estimator.close_loops(arrival.registrations);
      const double update_ms = update_timer.stop();
      // In batch mode nothing is solved here: only the decisions on the registrations count, and
      // whether they could be taken.
      if (batch) {
        if (!is_done(report.outcome)) result.outcome = worse(result.outcome, report.outcome);
        result.loops.insert(result.loops.end(), report.loops.begin(), report.loops.end());
      } else {
        note(report, update_ms, result);
      }
    }
    newest.ask(estimator);
    if (options.progress) options.progress(k + 1, log.size());
  }
  if (!batch) return;
  const CallTimer timer(result);
  const UpdateReport report = estimator.finish(options.start);
  const double solve_ms = timer.stop();
  note(report, solve_ms, result);
  if (is_done(report.outcome)) return;
  for (LoopDecision& loop : result.loops) {
    if (loop.fate == LoopFate::used) loop.fate = LoopFate::lost;
  }
}

void collect_weights(const Estimator& estimator, Replay& result) {
  result.loop_weights = estimator.loop_weights();
  if (result.loop_weights.empty()) result.loop_weights.assign(result.loops.size(), 1.0);
  for (std::size_t j = 0; j < result.loops.size(); ++j) {
    if (result.loops[j].fate != LoopFate::used) result.loop_weights[j] = 0.0;
  }
}

void collect_covariances(Estimator& estimator, Replay& result) {
  const auto start = Clock::now();
  std::vector<Eigen::Matrix3d> covariances;
  for (std::size_t k = 0; k < estimator.size(); ++k) {
    const auto covariance = estimator.covariance(k);
    if (!covariance) return;
    covariances.push_back(*covariance);
  }
  result.covariance_ms = milliseconds_since(start);
  result.covariances = std::move(covariances);
}

// Of one group of motions with one joint covariance, of every keyframe that is in it.
void collect_motions(const Estimator& estimator, JudgedMotions& motions) {
  std::vector<std::size_t> keyframes;
  for (const auto& [from, to] : motions.pairs) keyframes.insert(keyframes.end(), {from, to});
  std::ranges::sort(keyframes);
  const auto repeated = std::ranges::unique(keyframes);
  keyframes.erase(repeated.begin(), repeated.end());
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
void note_fault(const std::string& fault, Replay& result) {
  result.fault = fault;
  result.outcome = Outcome::numerical_failure;
  for (LoopDecision& loop : result.loops) {
    if (loop.fate == LoopFate::used) loop.fate = LoopFate::lost;
  }
  result.loop_weights.assign(result.loops.size(), 0.0);
  result.covariances.reset();
  result.newest_covariance_ms.clear();
  for (JudgedMotions& motions : result.motions) motions.covariances.clear();
}

// The loops of the replay stand in the order of the log's registrations.
double cost_used(const MeasurementLog& log, const Estimator& estimator, const Replay& result) {
  double sum = 0.0;
  std::size_t loop = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    const auto chi2_of = [&](const RelativePose& z) {
      return chi2(z, result.trajectory[z.from], result.trajectory[z.to]);
    };
    sum += chi2_of(arrival.step);
    for (const RelativePose& z : arrival.registrations) {
      if (result.loops[loop++].fate == LoopFate::used) sum += estimator.loss(chi2_of(z));
    }
  }
  return sum;
}

}  // namespace

Replay replay(const MeasurementLog& log, const EstimatorEntry& entry, const EstimatorValues& values,
              const ReplayOptions& options) {
  Replay result;
  // Not to be counted as the estimator's.
  result.loops.reserve(log.registration_count());
  result.update_ms.reserve(log.size());
  result.add_ms.reserve(log.size());
  if (options.newest_covariances) result.newest_covariance_ms.reserve(log.size());
  if (options.memory != nullptr) options.memory->start();
  GuardedEstimator estimator(entry, {log.origin(), options.mode}, values);
  give_keyframes(log, estimator, options, result);
  if (options.memory != nullptr) result.memory_bytes = options.memory->stop();
  result.trajectory = poses_of(estimator);
  collect_weights(estimator, result);
  if (options.covariances) collect_covariances(estimator, result);
  result.motions = options.motions;
  for (JudgedMotions& motions : result.motions) {
    motions.covariances.clear();
    collect_motions(estimator, motions);
  }
  result.cost_used = cost_used(log, estimator, result);
  if (!estimator.fault().empty()) note_fault(estimator.fault(), result);
  return result;
}

}  // namespace fathom
