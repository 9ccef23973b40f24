#include "study_results.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/input_error.hpp"
#include "fathom/results/distinct_values.hpp"
#include "fathom/results/run_index.hpp"
#include "honesty.hpp"

namespace fathom {
namespace {

// Costs of other machines are no part of a figure.
std::optional<double> metric_of(const RunRecord& run, const std::string& metric,
                                const std::string* machine) {
  if (machine != nullptr && run.machine != *machine) return std::nullopt;
  const auto found = run.metrics.find(metric);
  if (found == run.metrics.end() || !std::isfinite(found->second)) return std::nullopt;
  return found->second;
}

// That a metric's figures are restricted to; null where they are not.
const std::string* machine_of(const EstimatorResults& estimator, const std::string& metric) {
  return is_cost_metric(metric) ? &estimator.cost_machine : nullptr;
}

// Of all trials, or of these alone; nothing where none of them has the metric.
std::optional<MetricSummary> summary_of(const EstimatorResults& estimator,
                                        const std::string& metric,
                                        const std::set<TrialKey>* trials = nullptr) {
  DistinctValues distinct(metric);
  std::vector<double> all;
  const std::string* machine = machine_of(estimator, metric);
  for (const RunRecord& run : estimator.runs) {
    const auto value = metric_of(run, metric, machine);
    if (is_failed(run) || !value) continue;
    if (trials != nullptr && !trials->contains(run.key.trial_key())) continue;
    distinct.add(run, *value);
    all.push_back(*value);
  }
  if (all.empty()) return std::nullopt;
  const ClusteredValues values = distinct.values();
  MetricSummary summary{*moments(all), values.size(), hierarchical_interval(values)};
  summary.moments.mean = clustered_mean(values);
  return summary;
}

std::map<std::string, MetricSummary> summaries(const EstimatorResults& estimator,
                                               const std::vector<std::string>& metrics) {
  std::map<std::string, MetricSummary> all;
  for (const std::string& metric : metrics) {
    if (const auto summary = summary_of(estimator, metric)) all[metric] = *summary;
  }
  return all;
}

void count_outcomes(EstimatorResults& estimator) {
  for (const RunRecord& run : estimator.runs) {
    estimator.done += is_failed(run) ? 0 : 1;
    if (!run.outcome.empty()) ++estimator.outcomes[run.outcome];
  }
}

void sum_up(EstimatorResults& estimator, const std::vector<std::string>& metrics,
            Repetition repetition) {
  estimator.metrics = summaries(estimator, metrics);
  std::set<std::string> of_honesty;
  std::set<std::size_t> surveys;
  for (const RunRecord& run : estimator.runs) {
    for (const auto& [metric, value] : run.metrics) {
      if (is_of_honesty(metric)) of_honesty.insert(metric);
    }
    if (!is_failed(run)) surveys.insert(run.key.survey);
  }
  estimator.consistency = summaries(estimator, {of_honesty.begin(), of_honesty.end()});
  estimator.honesty = honesty_of(estimator.consistency,
                                 independent_draws(repetition, surveys.size(), estimator.done),
                                 estimator.considers_shared_errors);
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
      const auto paired = difference_between(*other, *first, metric);
      if (paired) cell.paired.push_back({other->name, metric, *paired, std::nullopt});
    }
  }
  adjust(cell.paired);
}

std::vector<std::string> all_metrics(const RunIndex& index) {
  const std::vector<std::string> known = index.metrics();
  std::set<std::string> others(known.begin(), known.end());
  std::vector<std::string> names;
  for (const std::string& name : index.study().metrics) {
    if (others.erase(name) > 0) names.push_back(name);
  }
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

// All runs of a cell: dead reckoning first, then the estimators as in the study.
CellResults runs_of(const RunIndex& index, std::size_t number, const std::string& cost_machine) {
  const StudyDescription& study = index.study();
  CellResults cell;
  cell.cell = number;
  cell.label = study.label_of(number);
  cell.association = study.association_of(number);
  cell.selected_by = study.selected_by(number);
  cell.contender_selects = study.selector_of(number).kind == LoopSelector::Kind::contender;
  cell.alignment = study.alignment_of(number);
  std::vector<std::string> names{kDeadReckoning};
  for (const StudyEstimator& estimator : study.estimators) names.push_back(estimator.name);
  std::set<TrialKey> trials;
  for (const std::string& name : names) {
    EstimatorResults one;
    one.name = name;
    one.cost_machine = cost_machine;
    one.considers_shared_errors = study.considers_shared_errors(number, name);
    for (const auto& [trial, run] : index.of(name, number)) {
      trials.insert(trial);
      if (name != kDeadReckoning) cell.jobs.insert(run->jobs);
      one.runs.push_back(*run);
    }
    if (!one.runs.empty()) cell.estimators.push_back(std::move(one));
  }
  cell.trials = trials.size();
  std::set<std::size_t> surveys;
  for (const TrialKey& trial : trials) surveys.insert(trial.survey);
  cell.surveys = surveys.size();
  cell.repetition = study.repetition_of(number);
  cell.repeats = repeats_there(study, cell);
  return cell;
}

// By survey, over the trials that both did and that have the metric.
ClusteredValues differences_between(const EstimatorResults& one, const EstimatorResults& other,
                                    const std::string& metric, double times,
                                    const std::set<TrialKey>* trials) {
  std::map<TrialKey, const RunRecord*> of_other;
  const std::string* machine = machine_of(one, metric);
  for (const RunRecord& run : other.runs) {
    if (!is_failed(run) && metric_of(run, metric, machine)) of_other[run.key.trial_key()] = &run;
  }
  DistinctValues differences(metric);
  for (const RunRecord& run : one.runs) {
    const auto value = metric_of(run, metric, machine);
    const auto found = of_other.find(run.key.trial_key());
    if (is_failed(run) || !value || found == of_other.end()) continue;
    if (trials != nullptr && !trials->contains(run.key.trial_key())) continue;
    differences.add(run, *found->second, *value,
                    times * *metric_of(*found->second, metric, machine));
  }
  return differences.values();
}

}  // namespace

std::set<TrialKey> trials_with(const EstimatorResults& one, const std::string& metric) {
  std::set<TrialKey> trials;
  const std::string* machine = machine_of(one, metric);
  for (const RunRecord& run : one.runs) {
    if (!is_failed(run) && metric_of(run, metric, machine)) trials.insert(run.key.trial_key());
  }
  return trials;
}

MetricSummary summary_over(const EstimatorResults& one, const std::string& metric,
                           const std::set<TrialKey>& trials) {
  const auto own = one.metrics.find(metric);
  const bool is_own = own != one.metrics.end() && own->second.moments.count == trials.size();
  return is_own ? own->second : summary_of(one, metric, &trials).value();
}

std::optional<PairedDifference> difference_between(const EstimatorResults& one,
                                                   const EstimatorResults& other,
                                                   const std::string& metric,
                                                   const BootstrapOptions& options, double times,
                                                   const std::set<TrialKey>* trials) {
  return difference_over_surveys(differences_between(one, other, metric, times, trials), options);
}

std::optional<SignedRankTest> test_between(const EstimatorResults& one,
                                           const EstimatorResults& other, const std::string& metric,
                                           const std::set<TrialKey>* trials) {
  return test_over_surveys(differences_between(one, other, metric, 1.0, trials));
}

StudyResults study_results(const ResultStore& store, MetricsOf metrics,
                           const std::optional<std::string>& machine) {
  const RunIndex index(store);
  if (index.runs().empty()) throw InputError("the study has no results yet; nothing to report");
  StudyResults results;
  results.study = index.study();
  results.machines = index.machines();
  results.cost_machine = machine.value_or(index.cost_machine());
  results.metrics = metrics == MetricsOf::runs ? all_metrics(index) : results.study.metrics;
  const std::string machines = machines_text(results);
  for (std::size_t number = 0; number < results.study.cell_count(); ++number) {
    CellResults cell = runs_of(index, number, results.cost_machine);
    if (cell.estimators.empty()) results.empty_cells.push_back(cell.label);
    if (cell.estimators.empty()) continue;
    cell.machines = machines;
    for (EstimatorResults& one : cell.estimators) {
      count_outcomes(one);
      if (metrics != MetricsOf::none) sum_up(one, results.metrics, cell.repetition);
    }
    if (metrics != MetricsOf::none) compare(cell, results.study);
    results.cells.push_back(std::move(cell));
  }
  return results;
}

std::vector<StudyResults> results_of_other_machines(const ResultStore& store,
                                                    const StudyResults& results,
                                                    MetricsOf metrics) {
  std::vector<StudyResults> others;
  for (const auto& [machine, runs] : results.machines) {
    if (machine != results.cost_machine) others.push_back(study_results(store, metrics, machine));
  }
  return others;
}

}  // namespace fathom
