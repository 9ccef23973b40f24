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

ShardPlan plan_of(const Study& study, const Shard& shard, const std::string& command_line) {
  const StudyDataSets data_sets(study, nullptr);
  const ShardTrials own(study, data_sets, shard);
  return {shard, own.count() * study.description.estimators.size(), command_line, own.range()};
}

int jobs_of(const Study& study) {
  const auto jobs = static_cast<std::size_t>(study.cells.front().study.jobs);
  return static_cast<int>(std::min(jobs, trials_in_all(study)));
}

}  // namespace fathom
