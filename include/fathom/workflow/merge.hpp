#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "fathom/results/merge.hpp"
#include "fathom/workflow/observer.hpp"

namespace fathom::workflow {

struct MergeOutcome {
  MergeSummary merged;
  std::string table;        ///< of the study's estimators; empty where there are no runs
  bool all_usable = false;  ///< whether each estimator has a run that can be used
};

/// Makes one study of its shards, with page and files, in the folder `out`, and says what looks
/// wrong with its example. Throws InputError.
MergeOutcome merge_studies(const std::vector<std::filesystem::path>& folders,
                           const std::filesystem::path& out, Observer& observer);

/// Whether each of these is a folder of registrations and not of a study (merge_registrations).
bool are_caches(const std::vector<std::filesystem::path>& folders);

}  // namespace fathom::workflow
