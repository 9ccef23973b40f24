#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/configuration/isolation.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/evaluation/relative_consistency.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Counts the heap memory that the calling thread holds, if the program can (the command line
/// interposes malloc; a program that links the library need not).
class MemoryMeter {
 public:
  virtual ~MemoryMeter() = default;
  /// Starts counting at zero.
  virtual void start() = 0;
  /// The peak since start, bytes.
  virtual std::int64_t stop() = 0;
  /// What is held for a while between these two is no part of the peak.
  virtual void pause() {}
  virtual void resume() {}
};

struct ReplayOptions {
  SolveMode mode = SolveMode::incremental;
  /// Initial guess of a batch solve; empty: dead reckoning, or connected_guess where that has
  /// holes or the start is free.
  std::span<const Pose> start;
  /// Covariances of all keyframes are asked for after the replay, outside the timing.
  bool covariances = true;
  /// After every keyframe's update the covariance of the newest pose is asked for: a duty that is
  /// the same for filters and graphs, timed apart. Of no effect in batch mode, which has no
  /// estimate until the end.
  bool newest_covariances = false;
  /// After each of these keyframes, rising, is added its motions from all others are asked for with
  /// their covariances, as the selection of loop candidates does. Their time is the estimate's:
  /// without them it would have been given another log.
  std::vector<std::size_t> candidate_covariances;
  /// Whether the estimator's own estimate selected the loop candidates of the log: evaluate() then
  /// puts here above what the recording says of it.
  bool own_candidates = false;
  /// Motions whose covariances are asked for after the replay, outside the timing. Those of
  /// `covariances` are not looked at.
  std::vector<JudgedMotions> motions;
  MemoryMeter* memory = nullptr;
  Progress progress;
  /// Of evaluate(), which decides by it between replay and isolated_replay.
  IsolationOptions isolation;
};

/// One estimator's estimate from a log, and what it cost. Cost is wall time of the estimator's
/// calls alone, on this thread; of what programs do for it their processor time, and their peak of
/// memory.
struct Replay {
  std::vector<Pose> trajectory;
  /// Of every keyframe; absent where not asked for or not to be had.
  std::optional<std::vector<Eigen::Matrix3d>> covariances;
  Outcome outcome = Outcome::converged;  ///< the worst of all updates
  /// How the estimator broke its contract (GuardedEstimator), one line; the outcome is
  /// `numerical_failure` then, or `crashed` where a program ended. Or how its process ended. Empty:
  /// neither.
  std::string fault;
  /// Of updates, by Outcome; no update has one from `crashed` on.
  std::array<std::size_t, 4> outcome_counts{};
  std::vector<LoopDecision> loops;
  /// The final weight of each (Estimator::loop_weights); 0 of those that are not used.
  std::vector<double> loop_weights;
  std::vector<AbsoluteDecision> absolute;
  std::vector<double> absolute_weights;  ///< likewise
  int iterations = 0;
  /// Of the last update, where the estimator says so (UpdateReport).
  std::optional<double> gradient_norm;
  std::optional<bool> is_local_minimum;
  /// Per update: a call with measurements, or the batch solve.
  std::vector<double> update_ms;
  std::vector<double> add_ms;  ///< per add_keyframe
  /// Per keyframe from 1 on, of the covariance of the newest pose; empty where not asked for or not
  /// to be had.
  std::vector<double> newest_covariance_ms;
  /// Of the covariances for loop candidates, where asked for: a part of total_ms.
  std::optional<double> candidate_covariance_ms;
  double total_ms = 0.0;  ///< of all calls but the covariances of poses and of `motions`
  double cpu_ms = 0.0;    ///< of the thread and its Workers, over the same calls
  double covariance_ms = 0.0;
  /// Where programs do the work (ProgramWork), the processor time of their start-up, no part of the
  /// others.
  std::optional<double> start_up_ms;
  std::optional<std::int64_t> memory_bytes;
  /// Those asked for, each with its covariances where they are to be had.
  std::vector<JudgedMotions> motions;
  double chi2_initial = 0.0;  ///< F at the initial guess, or at dead reckoning
  /// Σ ρ(eᵀ Ω e) over what the estimator used: what was rejected left out, loss applied.
  double cost_used = 0.0;
  double absolute_cost_used = 0.0;  ///< of it, absolute measurements and an uncertain start
};

/// Gives a log to an estimator, keyframe by keyframe, and measures.
Replay replay(const MeasurementLog& log, const EstimatorEntry& entry, const EstimatorValues& values,
              const ReplayOptions& options);

/// Of a run that left nothing but how it ended: poses are NaN, every measurement is lost.
Replay lost_replay(const MeasurementLog& log, const ReplayOptions& options, Outcome outcome,
                   const std::string& fault);

}  // namespace fathom
