#include "study_results.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/input_error.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom {
namespace {

std::optional<double> metric_of(const RunRecord& run, const std::string& metric) {
  const auto found = run.metrics.find(metric);
  if (found == run.metrics.end() || !std::isfinite(found->second)) return std::nullopt;
  return found->second;
}

std::vector<double> values_of(const EstimatorResults& estimator, const std::string& metric) {
  std::vector<double> values;
  for (const RunRecord& run : estimator.runs) {
    const auto value = metric_of(run, metric);
    if (is_done(run) && value) values.push_back(*value);
  }
  return values;
}

void sum_up(EstimatorResults& estimator, const std::vector<std::string>& metrics) {
  for (const RunRecord& run : estimator.runs) {
    estimator.done += is_done(run) ? 1 : 0;
    if (!run.outcome.empty()) ++estimator.outcomes[run.outcome];
  }
  for (const std::string& metric : metrics) {
    const std::vector<double> values = values_of(estimator, metric);
    if (values.empty()) continue;
    estimator.metrics[metric] = {*moments(values), bootstrap_interval(values)};
  }
}

std::optional<PairedDifference> difference(const EstimatorResults& one,
                                           const EstimatorResults& first,
                                           const std::string& metric) {
  std::map<std::size_t, double> of_first;
  for (const RunRecord& run : first.runs) {
    const auto value = metric_of(run, metric);
    if (is_done(run) && value) of_first[run.key.trial] = *value;
  }
  std::vector<double> a;
  std::vector<double> b;
  for (const RunRecord& run : one.runs) {
    const auto value = metric_of(run, metric);
    const auto other = of_first.find(run.key.trial);
    if (!is_done(run) || !value || other == of_first.end()) continue;
    a.push_back(*value);
    b.push_back(other->second);
  }
  return paired_difference(a, b);
}

// One family of tests a cell: what a reader of its block looks over at once. A single trial tests
// nothing.
void adjust(std::vector<PairedResult>& paired) {
  std::vector<double> p_values;
  const auto p_of = [](const PairedResult& one) {
    return one.difference.count > 1 ? one.difference.signed_rank.p_value : std::nullopt;
  };
  for (const PairedResult& one : paired) {
    if (p_of(one)) p_values.push_back(*p_of(one));
  }
  const std::vector<double> adjusted = holm(p_values);
  auto next = adjusted.begin();
  for (PairedResult& one : paired) {
    if (p_of(one)) one.holm_p = *next++;
  }
}

void compare(CellResults& cell, const StudyDescription& study) {
  const auto first = std::find_if(cell.estimators.begin(), cell.estimators.end(),
                                  [](const auto& one) { return one.name != kDeadReckoning; });
  // Where the first of the study has no runs here, nothing stands in for it.
  if (first == cell.estimators.end() || study.estimators.empty() ||
      first->name != study.estimators.front().name) {
    return;
  }
  for (auto other = first + 1; other != cell.estimators.end(); ++other) {
    for (const std::string& metric : study.metrics) {
      const auto paired = difference(*other, *first, metric);
      if (paired) cell.paired.push_back({other->name, metric, *paired, std::nullopt});
    }
  }
  adjust(cell.paired);
}

std::vector<std::string> all_metrics(const StudyDescription& study,
                                     const std::vector<RunRecord>& runs) {
  std::set<std::string> others;
  for (const RunRecord& run : runs) {
    for (const auto& [name, value] : run.metrics) others.insert(name);
  }
  std::vector<std::string> names;
  for (const std::string& name : study.metrics) {
    if (others.erase(name) > 0) names.push_back(name);
  }
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

CellResults& cell_of(StudyResults& results, std::size_t cell) {
  if (results.cells.empty() || results.cells.back().cell != cell) {
    CellResults next;
    next.cell = cell;
    next.label = results.study.label_of(cell);
    next.association = results.study.association_of(cell);
    next.alignment = results.study.alignment_of(cell);
    results.cells.push_back(std::move(next));
  }
  return results.cells.back();
}

// Runs come in the order of cell and trial, within a trial dead reckoning first: the order in which
// estimators are first seen is not the study's where the first trial lacks one.
void put_in_order(CellResults& cell, const StudyDescription& study) {
  const auto place = [&study](const EstimatorResults& one) {
    if (one.name == kDeadReckoning) return std::size_t{0};
    const auto found = std::find_if(study.estimators.begin(), study.estimators.end(),
                                    [&](const auto& known) { return known.name == one.name; });
    return static_cast<std::size_t>(found - study.estimators.begin()) + 1;
  };
  std::stable_sort(cell.estimators.begin(), cell.estimators.end(),
                   [&](const auto& a, const auto& b) { return place(a) < place(b); });
}

}  // namespace

bool is_done(const RunRecord& run) {
  return run.outcome.empty() || run.outcome == name_of(Outcome::converged) ||
         run.outcome == name_of(Outcome::iteration_limit);
}

StudyResults study_results(const ResultStore& store, MetricsOf metrics) {
  StudyResults results;
  results.study = store.study();
  const std::vector<RunRecord> runs = store.runs();
  if (runs.empty()) throw InputError("the study has no results yet; nothing to report");
  results.metrics =
      metrics == MetricsOf::study ? results.study.metrics : all_metrics(results.study, runs);
  std::set<std::pair<std::size_t, std::size_t>> trials;
  for (const RunRecord& run : runs) {
    CellResults& cell = cell_of(results, run.key.cell);
    if (trials.insert({run.key.cell, run.key.trial}).second) ++cell.trials;
    if (run.key.estimator != kDeadReckoning) cell.jobs.insert(run.jobs);
    auto one = std::find_if(cell.estimators.begin(), cell.estimators.end(),
                            [&](const auto& known) { return known.name == run.key.estimator; });
    if (one == cell.estimators.end()) {
      one = cell.estimators.insert(one, EstimatorResults{run.key.estimator, {}, 0, {}, {}});
    }
    one->runs.push_back(run);
  }
  for (CellResults& cell : results.cells) {
    put_in_order(cell, results.study);
    for (EstimatorResults& one : cell.estimators) sum_up(one, results.metrics);
    compare(cell, results.study);
  }
  return results;
}

}  // namespace fathom
