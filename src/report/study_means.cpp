#include "fathom/report/study_report.hpp"
#include "fathom/results/distinct_values.hpp"
#include "ranking.hpp"
#include "regime_map.hpp"
#include "study_results.hpp"

namespace fathom {
namespace {

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

double mean_over(const EstimatorResults& one, const std::string& metric,
                 const std::set<TrialKey>& trials) {
  DistinctValues values(metric);
  for (const RunRecord& run : one.runs) {
    if (trials.contains(run.key.trial_key())) values.add(run, run.metrics.at(metric));
  }
  return clustered_mean(values.values());
}

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

RelativeMeans means_over_best(const ResultStore& store, const std::string& metric) {
  RelativeMeans all;
  const auto what = is_of_optimum(metric) ? MetricsOf::study : MetricsOf::none;
  const StudyResults results = study_results(store, what);
  for (const CellResults& cell : results.cells) {
    all[cell.cell] = relative_to_best(cell, metric);
  }
  return all;
}

}  // namespace fathom
