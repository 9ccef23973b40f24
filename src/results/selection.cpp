#include "fathom/results/selection.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cell_means.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "selection_query.hpp"
#include "selection_runs.hpp"

namespace fathom {
namespace {

// The values of one metric, a list per cell; nothing where a run that is done has none, or where a
// cell has no run that is done.
using CellValues = std::vector<std::vector<double>>;

// The runs that are compared: the common trials of each cell looked at.
struct Compared {
  const StudyRuns& runs;
  std::vector<std::size_t> asked;                ///< cells, with such a trial or not
  std::vector<std::size_t> cells;                ///< those with one
  std::vector<std::vector<std::size_t>> trials;  ///< of each of the cells
};

Compared compared_runs(const StudyRuns& runs, const std::vector<std::size_t>& asked) {
  Compared compared{runs, asked, {}, {}};
  for (const std::size_t cell : asked) {
    std::vector<std::size_t> trials = runs.common_trials(cell);
    if (trials.empty()) continue;
    compared.cells.push_back(cell);
    compared.trials.push_back(std::move(trials));
  }
  if (compared.cells.empty()) {
    throw InputError(
        "no trial has been run by all estimators of the study yet; the same 'fathom compare' goes "
        "on with it");
  }
  return compared;
}

// Nothing for a trial that failed or that dead reckoning has not.
const RunRecord* done_run(const Compared& compared, const std::string& estimator, std::size_t c,
                          std::size_t trial) {
  const StudyRuns::Trials& trials = compared.runs.of(estimator, compared.cells[c]);
  const auto run = trials.find(trial);
  return run == trials.end() || is_failed(*run->second) ? nullptr : run->second;
}

std::optional<std::vector<double>> values_in(const Compared& compared, const std::string& estimator,
                                             std::size_t c, const std::string& metric) {
  std::vector<double> values;
  for (const std::size_t trial : compared.trials[c]) {
    const RunRecord* run = done_run(compared, estimator, c, trial);
    if (run == nullptr) continue;
    const auto value = run->metrics.find(metric);
    if (value == run->metrics.end()) return std::nullopt;
    values.push_back(value->second);
  }
  if (values.empty()) return std::nullopt;
  return values;
}

Verdict verdict_of(const Requirement& requirement, const TrialMean& value) {
  if (requirement.holds(decisive_end(requirement, value))) return Verdict::meets;
  return requirement.holds(value.mean) ? Verdict::not_shown : Verdict::fails;
}

// How far a value reaches to the wrong side, as a share of the bound; below 0 it does not.
double excess(const Requirement& requirement, const Judgement& judgement) {
  if (!judgement.value) return std::numeric_limits<double>::infinity();
  const double over = decisive_end(requirement, *judgement.value) - requirement.bound;
  const double scale = requirement.bound == 0.0 ? 1.0 : std::abs(requirement.bound);
  return (requirement.is_upper_bound() ? over : -over) / scale;
}

Judgement judge(const Compared& compared, const std::string& estimator,
                const Requirement& requirement) {
  std::optional<Judgement> worst;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    Judgement judgement{Verdict::not_measured, compared.cells[c], std::nullopt};
    if (const auto values = values_in(compared, estimator, c, requirement.metric)) {
      judgement.value = mean_over_cells({*values});
      judgement.verdict = verdict_of(requirement, *judgement.value);
    }
    const bool is_worse = !worst || judgement.verdict > worst->verdict ||
                          (judgement.verdict == worst->verdict &&
                           excess(requirement, judgement) > excess(requirement, *worst));
    if (is_worse) worst = judgement;
  }
  return *worst;
}

std::optional<TrialMean> objective_of(const Compared& compared, const std::string& estimator,
                                      const std::string& metric) {
  CellValues cells;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    auto values = values_in(compared, estimator, c, metric);
    if (!values) return std::nullopt;
    cells.push_back(std::move(*values));
  }
  return mean_over_cells(cells);
}

EstimatorEvidence evidence_of(const Compared& compared, const std::string& estimator,
                              const SelectionQuery& query) {
  EstimatorEvidence evidence;
  evidence.name = estimator;
  evidence.meets_all = true;
  for (const Requirement& requirement : query.requirements) {
    evidence.judgements.push_back(judge(compared, estimator, requirement));
    evidence.meets_all = evidence.meets_all && evidence.judgements.back().verdict == Verdict::meets;
  }
  evidence.objective = objective_of(compared, estimator, query.objective);
  // A failure counts even in a trial that other estimators have yet to run.
  for (const std::size_t cell : compared.asked) {
    for (const auto& [trial, run] : compared.runs.of(estimator, cell)) {
      ++evidence.runs;
      if (is_failed(*run)) ++evidence.failed;
    }
  }
  evidence.has_too_many_failures =
      static_cast<double>(evidence.failed) >
      query.allowed_failures * static_cast<double>(evidence.runs) * (1.0 + 1e-12);
  evidence.meets_all = evidence.meets_all && !evidence.has_too_many_failures;
  return evidence;
}

// Best first; equal ones stay in the order of the study.
std::vector<std::size_t> ranked(const std::vector<EstimatorEvidence>& all, bool maximise) {
  std::vector<std::size_t> order;
  for (std::size_t e = 0; e < all.size(); ++e) {
    if (all[e].meets_all && all[e].objective) order.push_back(e);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double difference = all[a].objective->mean - all[b].objective->mean;
    return maximise ? difference > 0.0 : difference < 0.0;
  });
  return order;
}

Lead lead_over(const Compared& compared, const SelectionQuery& query, const std::string& chosen,
               const std::string& other) {
  std::vector<double> ours;
  std::vector<double> theirs;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    for (const std::size_t trial : compared.trials[c]) {
      const RunRecord* a = done_run(compared, chosen, c, trial);
      const RunRecord* b = done_run(compared, other, c, trial);
      if (a == nullptr || b == nullptr) continue;
      ours.push_back(a->metrics.at(query.objective));
      theirs.push_back(b->metrics.at(query.objective));
    }
  }
  Lead lead;
  lead.difference = paired_difference(ours, theirs);
  if (!lead.difference || !lead.difference->interval) return lead;
  const Interval& interval = *lead.difference->interval;
  constexpr double kLevel = 0.05;
  lead.is_significant = (query.maximise ? interval.low > 0.0 : interval.high < 0.0) &&
                        lead.difference->signed_rank.p_value.value_or(1.0) <= kLevel;
  return lead;
}

// Fewest of the conditions missed, then by the least share of the bounds.
std::size_t nearest_of(const std::vector<EstimatorEvidence>& all, const SelectionQuery& query) {
  std::size_t best = 0;
  std::pair<std::size_t, double> least{std::numeric_limits<std::size_t>::max(), 0.0};
  for (std::size_t e = 0; e < all.size(); ++e) {
    std::pair<std::size_t, double> missed{all[e].has_too_many_failures ? 1 : 0, 0.0};
    for (std::size_t r = 0; r < query.requirements.size(); ++r) {
      const Judgement& judgement = all[e].judgements[r];
      if (judgement.verdict == Verdict::meets) continue;
      ++missed.first;
      missed.second += excess(query.requirements[r], judgement);
    }
    if (missed >= least) continue;
    least = missed;
    best = e;
  }
  return best;
}

std::vector<std::size_t> requirements_met_by_none(const Selection& selection, std::size_t count) {
  std::vector<std::size_t> all;
  for (std::size_t r = 0; r < count; ++r) {
    const bool met = std::any_of(selection.estimators.begin(), selection.estimators.end(),
                                 [r](const EstimatorEvidence& evidence) {
                                   return evidence.judgements[r].verdict == Verdict::meets;
                                 });
    if (!met) all.push_back(r);
  }
  return all;
}

std::vector<std::string> remarks_on(const Compared& compared, const Selection& selection,
                                    const SelectionQuery& query) {
  const std::vector<std::size_t>& asked = compared.asked;
  std::vector<std::string> remarks;
  if (std::string gaps = compared.runs.unfinished(asked); !gaps.empty()) {
    remarks.push_back(std::move(gaps));
  }
  if (selection.cells.size() < asked.size()) {
    remarks.push_back(std::to_string(asked.size() - selection.cells.size()) + " of " +
                      std::to_string(asked.size()) +
                      " cells have no trial that all estimators have run: nothing is said of them");
  }
  if (selection.fewest_trials == 1) {
    remarks.emplace_back(
        "one trial is no evidence: a cell with one has no interval, its value itself was compared");
  }
  for (const EstimatorEvidence& evidence : selection.estimators) {
    if (evidence.failed == 0) continue;
    remarks.push_back(evidence.name + ": " + std::to_string(evidence.failed) + " of " +
                      std::to_string(evidence.runs) + " runs failed and are left out of its means" +
                      (evidence.has_too_many_failures ? "; it is out for that" : ""));
  }
  const bool has_cost =
      is_cost_metric(query.objective) ||
      std::any_of(query.requirements.begin(), query.requirements.end(),
                  [](const Requirement& needed) { return is_cost_metric(needed.metric); });
  if (const int jobs = compared.runs.most_jobs(selection.cells); has_cost && jobs > 1) {
    remarks.push_back("measured with " + std::to_string(jobs) +
                      " jobs at a time: costs are comparable at 1 alone");
  }
  return remarks;
}

void choose(Selection& selection, const Compared& compared, const SelectionQuery& query) {
  const std::vector<std::size_t> order = ranked(selection.estimators, query.maximise);
  selection.met_by_none = requirements_met_by_none(selection, query.requirements.size());
  if (order.empty()) {
    selection.nearest = nearest_of(selection.estimators, query);
    return;
  }
  selection.chosen = order.front();
  selection.nearest = order.front();
  if (order.size() < 2) return;
  selection.lead = lead_over(compared, query, selection.estimators[order[0]].name,
                             selection.estimators[order[1]].name);
  selection.lead->runner_up = order[1];
}

}  // namespace

std::string name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::meets:
      return "meets";
    case Verdict::not_shown:
      return "not shown";
    case Verdict::fails:
      return "fails";
    case Verdict::not_measured:
      break;
  }
  return "not measured";
}

Selection select_estimator(const ResultStore& store, const SelectionQuery& query) {
  const StudyRuns runs(store);
  const std::vector<std::size_t> asked = cells_where(runs.study(), query.where);
  require_metrics(query, runs.study(), runs.metrics());
  const Compared compared = compared_runs(runs, asked);
  Selection selection;
  selection.cells = compared.cells;
  selection.cells_asked = asked.size();
  selection.fewest_trials = compared.trials.front().size();
  for (const std::vector<std::size_t>& trials : compared.trials) {
    selection.fewest_trials = std::min(selection.fewest_trials, trials.size());
    selection.most_trials = std::max(selection.most_trials, trials.size());
  }
  for (const StudyEstimator& estimator : runs.study().estimators) {
    selection.estimators.push_back(evidence_of(compared, estimator.name, query));
  }
  EstimatorEvidence baseline = evidence_of(compared, kDeadReckoning, query);
  if (baseline.runs > 0) selection.baseline = std::move(baseline);
  choose(selection, compared, query);
  selection.remarks = remarks_on(compared, selection, query);
  return selection;
}

}  // namespace fathom
