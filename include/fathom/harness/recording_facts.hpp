#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fathom/estimation/registry.hpp"
#include "fathom/evaluation/loop_truth.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/measurements/loop_terms.hpp"

namespace fathom {

/// What the evaluation of runs needs and no estimator changes: computed once a recording.
struct RecordingFacts {
  std::optional<TrueOverlaps> true_overlaps;
  /// F at the batch_optimum; of a study alone.
  std::optional<double> chi2_optimum;
  std::optional<double> shared_chi2_optimum;  ///< shared_chi2 at its own
  std::optional<LoopTerms> loop_terms;        ///< of a study alone
  std::string log_hash;                       ///< of the measurement log as text; of a study alone

  /// Of the F with these errors.
  std::optional<double> optimum(RegistrationErrors errors, const MeasurementLog& log) const {
    const bool is_shared = errors == RegistrationErrors::shared && log.tells_shared_errors();
    return is_shared ? shared_chi2_optimum : chi2_optimum;
  }
};

/// The facts of a single run.
RecordingFacts run_facts(const Recording& recording);

/// The facts of a study's run.
RecordingFacts study_facts(const Recording& recording, const EstimatorRegistry& registry);

/// Of keyframes at these poses, with a camera that took their pictures as it stood there.
TrueOverlaps overlaps_at(std::span<const Pose> poses, const Camera& camera,
                         std::span<const Stance> stances);

/// From ground truth, altitudes and camera; nothing where one of them is not known.
std::optional<TrueOverlaps> true_overlaps(const Recording& recording);

/// The batch optimum: the least F that a batch solve of a log reaches.
struct BatchOptimum {
  std::vector<Pose> poses;
  double chi2 = 0.0;
  std::string solver;           ///< the type of the estimator that reached it
  EstimatorValues values = {};  ///< its options
  RegistrationErrors errors = RegistrationErrors::independent;  ///< of F
};

/// Over all estimators of the registry that can solve a batch, each with its default options and
/// from these poses (dead reckoning, if empty). Nothing where none of them comes to an end.
/// `errors` says of which F; estimators that could estimate shared errors do so for that one alone.
std::optional<BatchOptimum> batch_optimum(
    const MeasurementLog& log, const EstimatorRegistry& registry, std::span<const Pose> start = {},
    RegistrationErrors errors = RegistrationErrors::independent);

}  // namespace fathom
