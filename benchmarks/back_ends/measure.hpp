#pragma once

#include <optional>
#include <string>

#include "fathom/estimation/registry.hpp"
#include "fathom/evaluation/summary.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom::benchmarks {

/// An estimator with values for some of its options; the others have their defaults.
struct Contender {
  std::string label;
  const EstimatorEntry* entry = nullptr;
  EstimatorValues values;
  bool is_for_batch_alone = false;
};

/// What one estimator made of one log, and what that cost, in the fastest of several replays.
struct Cost {
  std::string estimator;  ///< the contender's label
  SolveMode mode = SolveMode::incremental;
  Outcome outcome = Outcome::converged;
  bool gave_up = false;  ///< over the budget: only the time is known, and that it is too small
  int linearisations = 0;
  double chi2 = 0.0;
  double total_ms = 0.0;                ///< CPU time of the thread, of all calls
  std::optional<Summary> update_ms;     ///< incremental: wall time of an update
  std::optional<double> covariance_ms;  ///< of all keyframes; absent where they cannot be had
  std::optional<double> memory_mib;     ///< peak of what the estimator holds
};

struct Effort {
  int repeats = 5;
  double budget_s = 60.0;  ///< CPU time of all repeats, and so the most that one may take
  bool covariances = true;
};

/// Replays a log through an estimator.
Cost measure(const MeasurementLog& log, const Contender& contender, SolveMode mode,
             const Effort& effort);

}  // namespace fathom::benchmarks
