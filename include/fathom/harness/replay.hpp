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

#include "fathom/estimation/registry.hpp"
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
};

struct ReplayOptions {
  SolveMode mode = SolveMode::incremental;
  /// Initial guess of a batch solve; empty: dead reckoning.
  std::span<const Pose> start;
  /// Covariances of all keyframes are asked for after the replay, outside the timing.
  bool covariances = true;
  MemoryMeter* memory = nullptr;
  Progress progress;
};

/// One estimator's estimate from a log, and what it cost. Cost is wall time of the estimator's
/// calls alone, on this thread.
struct Replay {
  std::vector<Pose> trajectory;
  /// Of every keyframe; absent where not asked for or not to be had.
  std::optional<std::vector<Eigen::Matrix3d>> covariances;
  Outcome outcome = Outcome::converged;  ///< the worst of all updates
  /// How the estimator broke its contract (GuardedEstimator), one line; the outcome is
  /// `numerical_failure` then. Empty: it did not.
  std::string fault;
  std::array<std::size_t, 4> outcome_counts{};  ///< of updates, by Outcome
  std::vector<LoopDecision> loops;
  /// The final weight of each (Estimator::loop_weights); 0 of those that are not used.
  std::vector<double> loop_weights;
  int iterations = 0;
  /// Of the last update, where the estimator says so (UpdateReport).
  std::optional<double> gradient_norm;
  std::optional<bool> is_local_minimum;
  /// Per update: a close_loops call with registrations, or the batch solve.
  std::vector<double> update_ms;
  std::vector<double> add_ms;  ///< per add_keyframe
  double total_ms = 0.0;       ///< of all calls but covariances
  double cpu_ms = 0.0;         ///< of the thread, over the same calls
  double covariance_ms = 0.0;
  std::optional<std::int64_t> memory_bytes;
  /// Σ ρ(eᵀ Ω e) over what the estimator used: rejected registrations left out, loss applied.
  double cost_used = 0.0;
};

/// Gives a log to an estimator, keyframe by keyframe, and measures.
Replay replay(const MeasurementLog& log, const EstimatorEntry& entry, const EstimatorValues& values,
              const ReplayOptions& options);

}  // namespace fathom
