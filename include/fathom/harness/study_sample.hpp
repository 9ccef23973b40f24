#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "fathom/configuration/study.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom {

/// Cells over the same pictures, of which some had a trial.
struct SampledPictures {
  std::vector<std::size_t> cells;
  double registrations_s = 0.0;  ///< processor seconds of its first trial's, from cold
  std::vector<double> trials_s;  ///< of one trial each, all estimators, pictures registered
};

/// What a few trials of a study took.
struct StudySample {
  std::vector<SampledPictures> groups;  ///< all cells of the study
  std::size_t trials = 0;
  double store_mib = 0.0;   ///< of their results
  double cache_mib = 0.0;   ///< of their registrations
  double memory_mib = 0.0;  ///< the most that this process has had
};

/// Runs the first trial of the first survey in the first cell of every group of pictures, then in
/// the others in turn; no further one begins after `budget_s`. Writes in a temporary folder alone.
StudySample sample_study(const Study& study, const EstimatorRegistry& registry, double budget_s,
                         const std::function<void()>& on_thread_start = {},
                         const Progress& progress = {});

}  // namespace fathom
