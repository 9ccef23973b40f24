#pragma once

#include "fathom/configuration/study.hpp"
#include "fathom/harness/study_sample.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

/// What a whole study takes, by a few of its trials.
struct Demand {
  double registrations_h = 0.0;  ///< processor hours
  double runs_h = 0.0;           ///< likewise
  double longest_trial_h = 0.0;  ///< of the trials that were run: no shard has less than one
  double store_mib = 0.0;
  double cache_mib = 0.0;
  double memory_mib = 0.0;         ///< of a job
  std::size_t surveys = 0;         ///< whose pictures are registered
  std::size_t trials = 0;          ///< in all
  std::size_t sampled_trials = 0;  ///< that this rests on
  std::size_t estimators = 0;
};

/// Runs the first trial of as many cells as `seconds` allow. Writes in a temporary folder alone.
/// Throws InputError.
Demand estimate(const Settings& settings, double seconds, const EstimatorRegistry& registry,
                const Machine& machine, Observer& observer);

}  // namespace fathom::workflow
