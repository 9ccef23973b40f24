#pragma once

#include <optional>
#include <string>

#include "fathom/estimation/registry.hpp"
#include "fathom/evaluation/summary.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom::benchmarks {

/// What one estimator made of one log, and what that cost: CPU time of the thread, of the fastest
/// of several runs.
struct Cost {
  std::string estimator;
  SolveMode mode = SolveMode::incremental;
  Outcome outcome = Outcome::converged;
  bool gave_up = false;  ///< over the budget; only the times are known, and too small
  int linearisations = 0;
  double chi2 = 0.0;
  double total_ms = 0.0;                ///< batch: of finish(); incremental: of all calls
  std::optional<Summary> step_ms;       ///< incremental: a keyframe with its registrations
  std::optional<double> covariance_ms;  ///< of all keyframes; absent where they cannot be had
  std::optional<double> memory_mib;     ///< peak of what the estimator holds
};

struct Effort {
  int repeats = 5;
  double budget_s = 60.0;  ///< of one run; the next is not begun beyond it
  bool covariances = true;
};

/// Runs an estimator at its defaults over a log.
Cost measure(const MeasurementLog& log, const EstimatorEntry& entry, SolveMode mode,
             const Effort& effort);

}  // namespace fathom::benchmarks
