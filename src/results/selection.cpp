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
    if (all[e].meets_all && all[e].objective && !all[e].shares_nothing_in) order.push_back(e);
  }
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double difference = all[a].objective->mean - all[b].objective->mean;
    return maximise ? difference > 0.0 : difference < 0.0;
  });
  return order;
}

// Whether the trial counts against nobody: one of them failed it, or has no objective there. Costs
// of another processor are no such thing.
bool is_lost(const Compared& compared, const std::vector<EstimatorEvidence*>& candidates,
             std::size_t c, const TrialKey& trial, const std::string& objective) {
  return std::ranges::any_of(candidates, [&](const EstimatorEvidence* one) {
    const RunRecord* run = done_run(compared, one->name, c, trial);
    return run == nullptr || !run->metrics.contains(objective);
  });
}

// Of candidates that share no trial of a cell the one with the fewest trials there; of equal ones
// the one that failed more, and then the last of the study.
EstimatorEvidence* poorest_in(const Compared& compared, std::size_t c,
                              const std::vector<EstimatorEvidence*>& candidates,
                              const std::string& objective) {
  const auto evidence = [&](const EstimatorEvidence* one) {
    const std::size_t trials = trials_of_all(compared, {one->name}, objective)[c].size();
    return std::pair(trials, std::numeric_limits<std::size_t>::max() - one->failed);
  };
  return *std::min_element(candidates.rbegin(), candidates.rend(),
                           [&](auto* a, auto* b) { return evidence(a) < evidence(b); });
}

// Those that meet all are compared over the trials in which all of them have the objective: where
// some failed the hard ones, their own means would be of easier trials. Who leaves a cell without
// such a trial is out, and not the cell.
std::vector<std::vector<TrialKey>> share_trials(Selection& selection, const Compared& compared,
                                                const std::string& objective) {
  std::vector<EstimatorEvidence*> candidates;
  for (EstimatorEvidence& one : selection.estimators) {
    if (one.meets_all && one.objective) candidates.push_back(&one);
  }
  std::vector<std::vector<TrialKey>> trials;
  for (;;) {
    std::vector<std::string> names;
    names.reserve(candidates.size());
    for (const EstimatorEvidence* one : candidates) names.push_back(one->name);
    trials = trials_of_all(compared, names, objective);
    const auto empty = std::ranges::find_if(trials, [](const auto& some) { return some.empty(); });
    if (names.size() < 2 || empty == trials.end()) break;
    const auto c = static_cast<std::size_t>(empty - trials.begin());
    EstimatorEvidence* out = poorest_in(compared, c, candidates, objective);
    out->shares_nothing_in = compared.cells[c];
    std::erase(candidates, out);
  }
  if (selection.baseline && selection.baseline->objective) {
    selection.baseline->objective = mean_over(compared, kDeadReckoning, objective, trials);
  }
  if (candidates.size() < 2) return trials;
  selection.fewest_shared = trials.front().size();
  for (std::size_t c = 0; c < trials.size(); ++c) {
    selection.fewest_shared = std::min(selection.fewest_shared, trials[c].size());
    selection.trials_left_out += static_cast<std::size_t>(std::ranges::count_if(
        compared.trials[c],
        [&](const TrialKey& trial) { return is_lost(compared, candidates, c, trial, objective); }));
  }
  for (EstimatorEvidence* one : candidates) {
    one->objective = mean_over(compared, one->name, objective, trials);
  }
  return trials;
}

Lead lead_over(const PairedDifference& difference, bool maximise) {
  Lead lead;
  lead.difference = difference;
  if (!difference.interval) return lead;
  constexpr double kLevel = 0.05;
  lead.is_significant =
      (maximise ? difference.interval->low > 0.0 : difference.interval->high < 0.0) &&
      difference.signed_rank.p_value.value_or(1.0) <= kLevel && difference.is_on_one_side();
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
  const auto trials = share_trials(selection, compared, query.objective);
  const std::vector<std::size_t> order = ranked(selection.estimators, query.maximise);
  selection.met_by_none = requirements_met_by_none(selection, query.requirements.size());
  if (order.empty()) {
    selection.nearest = nearest_of(selection.estimators, query);
    return;
  }
  selection.chosen = order.front();
  selection.nearest = order.front();
  if (order.size() < 2) return;
  const auto difference =
      difference_over(compared, selection.estimators[order[0]].name,
                      selection.estimators[order[1]].name, query.objective, trials);
  selection.lead = difference ? lead_over(*difference, query.maximise) : Lead{};
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
  selection.fewest_shared = selection.fewest_trials;
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
