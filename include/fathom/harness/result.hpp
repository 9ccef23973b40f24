#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "fathom/harness/replay.hpp"

namespace fathom {

/// How runs are evaluated.
struct JudgeOptions {
  MetricOptions metrics;
  /// Of the recording, where several runs share them; else they are made for this one.
  const RecordingFacts* facts = nullptr;
};

/// How an estimator is run: what its replay is asked for, and what evaluate() decides.
struct EvaluationOptions : ReplayOptions {
  /// Between replay and isolated_replay.
  IsolationOptions isolation;
  /// Whether the estimator's own estimate selected the loop candidates of the log:
  /// `candidate_covariances` are then those that the recording has of it.
  bool own_candidates = false;
};

/// Those of this configuration: the covariance of the newest pose after every keyframe, and what
/// loop candidates ask for where its own estimate selects them.
EvaluationOptions evaluation_options(const Configuration& configuration,
                                     const EstimatorConfiguration& estimator);

/// One estimator on one recording, evaluated by the harness.
struct Result {
  EstimatorConfiguration estimator;
  SolveMode mode = SolveMode::incremental;
  Run run;
  MetricOptions options;                  ///< of the metrics
  std::map<std::string, double> metrics;  ///< those that are known (metric_catalogue)
  std::optional<Accuracy> accuracy;       ///< with ground truth alone
  std::optional<Consistency> consistency;

  /// Whether the estimate can be used.
  bool is_done() const { return fathom::is_done(run.outcome); }
  /// Nothing where it is not known.
  std::optional<double> metric(const std::string& name) const;
};

/// Replays the recording to an estimator and evaluates its estimate. `ids` of loops and
/// trajectories are keyframe indices.
Result evaluate(const Recording& recording, const EstimatorConfiguration& estimator,
                const EstimatorRegistry& registry, const JudgeOptions& judging,
                const EvaluationOptions& options);

/// The same of a run that is known to have left nothing but how it ended: it is not made again.
Result evaluate_lost(const Recording& recording, const EstimatorConfiguration& estimator,
                     const EstimatorRegistry& registry, const JudgeOptions& judging,
                     Outcome outcome, const std::string& fault);

/// Dead reckoning judged as an estimate: the baseline of every table.
struct DeadReckoning {
  std::map<std::string, double> metrics;
  std::vector<Eigen::Matrix3d> covariances;  ///< of its poses, in their own axes (x, y, θ)
  std::optional<Consistency> consistency;    ///< with ground truth alone
};

/// Its steps composed, their covariances propagated to first order from an exact origin.
DeadReckoning judged_dead_reckoning(const Recording& recording, const MetricOptions& options);

/// The metrics of that.
std::map<std::string, double> dead_reckoning_metrics(const Recording& recording,
                                                     const MetricOptions& options);

/// The content of metrics.json (docs/outputs.md). What is not known is absent, never null or zero.
std::string metrics_json(const Result& result, const Recording& recording);

/// The same of a comparison: a list with an entry an estimator.
std::string comparison_json(const std::vector<Result>& results, const Recording& recording);

}  // namespace fathom
