#include "fathom/evaluation/clustered.hpp"
#include "fathom/report/study_report.hpp"
#include "ranking.hpp"
#include "study_results.hpp"

namespace fathom {
namespace {

double mean_over(const EstimatorResults& one, const std::string& metric,
                 const std::set<TrialKey>& trials) {
  ClusteredValues values;
  for (const RunRecord& run : one.runs) {
    if (trials.contains(run.key.trial_key())) {
      values[run.key.survey].push_back(run.metrics.at(metric));
    }
  }
  return clustered_mean(values);
}

StudyMeans means_of(const EstimatorResults& one, std::size_t cell) {
  StudyMeans means{cell, one.name, one.runs.size(), one.done, {}};
  std::set<std::string> metrics;
  for (const RunRecord& run : one.runs) {
    for (const auto& [metric, value] : run.metrics) metrics.insert(metric);
  }
  for (const std::string& metric : metrics) {
    const std::set<TrialKey> trials = trials_with(one, metric);
    if (!trials.empty()) means.means[metric] = mean_over(one, metric, trials);
  }
  return means;
}

}  // namespace

std::vector<StudyMeans> study_means(const ResultStore& store) {
  std::vector<StudyMeans> list;
  const StudyResults results = study_results(store, MetricsOf::none);
  for (const CellResults& cell : results.cells) {
    for (const EstimatorResults& one : cell.estimators) list.push_back(means_of(one, cell.cell));
  }
  return list;
}

std::string not_ranked_text(const ResultStore& store, const std::string& metric) {
  if (!is_of_optimum(metric)) return "";
  return no_ranking_text(study_results(store, MetricsOf::study), metric);
}

}  // namespace fathom
