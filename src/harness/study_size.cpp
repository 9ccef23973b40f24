#include <algorithm>
#include <map>
#include <set>

#include "fathom/harness/study_run.hpp"
#include "fathom/harness/survey.hpp"
#include "study_data_sets.hpp"
#include "study_tasks.hpp"

namespace fathom {

Fingerprint data_of(const Study& study) {
  std::set<std::string> opened;
  std::map<std::string, std::string> files;
  for (const Configuration& cell : study.cells) {
    if (!opened.insert(data_settings(cell)).second) continue;
    for (const auto& [file, hash] : fingerprint(open_data_set(cell)->files())) files[file] = hash;
  }
  return {files.begin(), files.end()};
}

std::size_t trials_in_all(const Study& study) {
  return study.cells.size() * study.description.surveys * study.description.trials;
}

std::size_t runs_of(const Study& study, const Shard& shard) {
  const StudyDataSets data_sets(study, nullptr);
  return ShardTrials(study, data_sets, shard).count() * study.description.estimators.size();
}

int jobs_of(const Study& study) {
  const auto jobs = static_cast<std::size_t>(study.cells.front().study.jobs);
  return static_cast<int>(std::min(jobs, trials_in_all(study)));
}

}  // namespace fathom
