#include "fathom/results/selection.hpp"

#include <algorithm>
#include <limits>
#include <set>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "selection_evidence.hpp"
#include "selection_query.hpp"

namespace fathom {
namespace {

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
  ClusteredValues differences;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    for (const TrialKey& trial : compared.trials[c]) {
      const RunRecord* a = done_run(compared, chosen, c, trial);
      const RunRecord* b = done_run(compared, other, c, trial);
      if (a == nullptr || b == nullptr) continue;
      differences[trial.survey].push_back(a->metrics.at(query.objective) -
                                          b->metrics.at(query.objective));
    }
  }
  Lead lead;
  lead.difference = difference_over_surveys(differences);
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

// "10 surveys × 10 trials", of cells that differ "10 surveys × 3 to 10 trials".
void count_trials(Selection& selection, const Compared& compared) {
  std::set<std::size_t> surveys;
  std::set<std::string> repeats;
  selection.fewest_trials = compared.trials.front().size();
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    const std::vector<TrialKey>& trials = compared.trials[c];
    selection.fewest_trials = std::min(selection.fewest_trials, trials.size());
    selection.most_trials = std::max(selection.most_trials, trials.size());
    for (const TrialKey& trial : trials) surveys.insert(trial.survey);
    repeats.insert(repeats_text(compared.runs.study().repetition_of(compared.cells[c]), trials));
  }
  selection.surveys = surveys.size();
  for (const std::string& one : repeats) {
    selection.repeats += (selection.repeats.empty() ? "" : " or ") + one;
  }
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
  if (!(query.allowed_failures >= 0.0 && query.allowed_failures <= 1.0)) {
    throw InputError("allowed failures: expected a share from 0 to 1, got " +
                     number_text(query.allowed_failures));
  }
  const RunIndex runs(store);
  const std::vector<std::size_t> asked = cells_where(runs.study(), query.where);
  require_metrics(query, runs.study(), runs.metrics());
  const Compared compared = compared_runs(runs, asked);
  Selection selection;
  selection.cells = compared.cells;
  selection.cells_asked = asked.size();
  count_trials(selection, compared);
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
