#include "fathom/workflow/merge.hpp"

#include <algorithm>

#include "fathom/core/files.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/results/result_store.hpp"
#include "study_files.hpp"

namespace fathom::workflow {
namespace {

namespace fs = std::filesystem;

// The example of a study, which one shard has: runs with their files, and what they share.
void copy_example(const std::vector<fs::path>& folders, const fs::path& out,
                  const StudyDescription& study) {
  const auto has_example = [](const fs::path& folder) {
    return fs::exists(folder / "trajectories.png");
  };
  const auto source = std::ranges::find_if(folders, has_example);
  if (source == folders.end() || fs::equivalent(*source, out)) return;
  std::vector<std::string> names{"metrics.json", "trajectories.png", "dead_reckoning.tum",
                                 "measurements.g2o"};
  names.insert(names.end(), optional_run_files().begin(), optional_run_files().end());
  for (const StudyEstimator& estimator : study.estimators) names.push_back(estimator.name);
  StagedFolder staged(out);
  for (const std::string& name : names) {
    if (!fs::exists(*source / name)) continue;
    fs::copy(*source / name, staged.path() / name, fs::copy_options::recursive);
  }
  staged.commit(optional_run_files());
}

// Those of its runs are the same.
std::vector<std::string> remarks_of_example(const fs::path& out, const StudyDescription& study) {
  return study.estimators.empty() ? std::vector<std::string>()
                                  : remarks_of_run(out / study.estimators.front().name);
}

}  // namespace

MergeOutcome merge_studies(const std::vector<fs::path>& folders, const fs::path& out,
                           Observer& observer) {
  require_no_run(out);
  MergeOutcome outcome{merge_stores(folders, out), {}, false};
  const ResultStore store = ResultStore::open(out);
  copy_example(folders, out, store.study());
  if (outcome.merged.runs > 0) outcome.table = write_study_files(store, out, observer);
  outcome.all_usable = all_usable(store);
  for (const std::string& remark : remarks_of_example(out, store.study())) {
    observer.remark(remark);
  }
  return outcome;
}

bool are_caches(const std::vector<fs::path>& folders) {
  return std::ranges::all_of(folders, [](const fs::path& folder) {
    return has_registrations(folder) && !fs::exists(folder / kResultsFile);
  });
}

}  // namespace fathom::workflow
