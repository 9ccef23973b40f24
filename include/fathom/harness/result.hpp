#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/evaluation/accuracy.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/evaluation/summary.hpp"
#include "fathom/harness/false_loops.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/replay.hpp"

namespace fathom {

/// One estimator on one recording, judged by the harness.
struct Result {
  EstimatorConfiguration estimator;
  SolveMode mode = SolveMode::incremental;
  Replay replay;
  double chi2 = 0.0;              ///< F of the whole log at the estimate
  double chi2_initial = 0.0;      ///< F where it started: dead reckoning, or the file's guess
  std::size_t loop_closures = 0;  ///< registrations used
  std::size_t rejected = 0;       ///< refused by the gate
  std::size_t lost = 0;           ///< let through, but their update failed
  std::size_t loops_kept = 0;     ///< registrations that weigh more than a half in the end
  /// Where it is known which registrations are false.
  std::optional<FalseLoopCounts> false_loop_counts;
  /// With ground truth alone, and with a second keyframe: an error at the origin is zero by choice.
  std::optional<Accuracy> accuracy;
  std::optional<RelativeError> relative_error;  ///< over one keyframe
  std::optional<Consistency> consistency;
  std::optional<Summary> update_ms;  ///< absent without an update

  /// Whether the estimate can be used.
  bool is_done() const { return fathom::is_done(replay.outcome); }
};

/// Replays the recording to an estimator and judges what comes out. `ids` of loops and trajectories
/// are keyframe indices.
Result evaluate(const Recording& recording, const EstimatorConfiguration& estimator,
                const EstimatorRegistry& registry, Alignment alignment,
                const ReplayOptions& options);

/// The accuracy of dead reckoning alone, the baseline of every table; absent as an estimator's.
std::optional<Accuracy> dead_reckoning_accuracy(const Recording& recording, Alignment alignment);

/// The content of metrics.json (docs/formats.md). What is not known is absent, never null or zero.
std::string metrics_json(const Result& result, const Recording& recording);

/// The same of a comparison: a list with an entry an estimator.
std::string comparison_json(const std::vector<Result>& results, const Recording& recording);

}  // namespace fathom
