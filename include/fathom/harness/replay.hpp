#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/estimation/registry.hpp"
#include "fathom/evaluation/run.hpp"
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
  /// Motions whose covariances are asked for after the replay, outside the timing. Those of
  /// `covariances` are not looked at.
  std::vector<JudgedMotions> motions;
  MemoryMeter* memory = nullptr;
  Progress progress;
};

/// Gives a log to an estimator, keyframe by keyframe, and measures.
Run replay(const MeasurementLog& log, const EstimatorEntry& entry, const EstimatorValues& values,
           const ReplayOptions& options);

/// Of a run that left nothing but how it ended: poses are NaN, every measurement is lost.
Run lost_run(const MeasurementLog& log, const ReplayOptions& options, Outcome outcome,
             const std::string& fault);

}  // namespace fathom
