#include "selection_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "cell_means.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/results/distinct_values.hpp"

namespace fathom {
namespace {

bool is_of_other_machine(const Compared& compared, const RunRecord& run,
                         const std::string& metric) {
  return is_cost_metric(metric) && run.machine != compared.runs.cost_machine();
}

// The values of one metric in a cell; nothing where a run that is done has none, or where no run is
// done.
std::optional<ClusteredValues> values_in(const Compared& compared, const std::string& estimator,
                                         std::size_t c, const std::vector<TrialKey>& trials,
                                         const std::string& metric) {
  DistinctValues values(metric);
  for (const TrialKey& trial : trials) {
    const RunRecord* run = done_run(compared, estimator, c, trial);
    if (run == nullptr || is_of_other_machine(compared, *run, metric)) continue;
    const auto value = value_of(compared, *run, metric);
    if (!value) return std::nullopt;
    values.add(*run, *value);
  }
  if (values.values().empty()) return std::nullopt;
  return values.values();
}

Verdict verdict_of(const Requirement& requirement, const TrialMean& value) {
  if (requirement.holds(decisive_end(requirement, value))) return Verdict::meets;
  return requirement.holds(value.mean) ? Verdict::not_shown : Verdict::fails;
}

Judgement judge(const Compared& compared, const std::string& estimator,
                const Requirement& requirement) {
  std::optional<Judgement> worst;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    Judgement judgement{Verdict::not_measured, compared.cells[c], std::nullopt};
    if (const auto values =
            values_in(compared, estimator, c, compared.trials[c], requirement.metric)) {
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

// What is tested. Of several surveys each has one value, its mean over the cells, as these count
// the same however many trials they have.
ClusteredValues by_survey(const std::vector<ClusteredValues>& cells, ClusteredValues pooled) {
  if (pooled.size() < 2) return pooled;
  ClusteredValues means;
  for (const ClusteredValues& cell : cells) {
    const std::vector<double> of_cell = survey_means(cell);
    auto mean = of_cell.begin();
    for (const auto& [survey, values] : cell) means[survey].push_back(*mean++);
  }
  return means;
}

}  // namespace

Compared compared_runs(const RunIndex& runs, const std::vector<std::size_t>& asked) {
  Compared compared{runs, asked, {}, {}};
  for (const std::size_t cell : asked) {
    std::vector<TrialKey> trials = runs.common_trials(cell);
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

const RunRecord* done_run(const Compared& compared, const std::string& estimator, std::size_t c,
                          const TrialKey& trial) {
  const RunIndex::Trials& trials = compared.runs.of(estimator, compared.cells[c]);
  const auto run = trials.find(trial);
  return run == trials.end() || is_failed(*run->second) ? nullptr : run->second;
}

std::optional<double> value_of(const Compared& compared, const RunRecord& run,
                               const std::string& metric) {
  const auto found = run.metrics.find(metric);
  if (found == run.metrics.end() || is_of_other_machine(compared, run, metric)) return std::nullopt;
  return found->second;
}

std::vector<std::vector<TrialKey>> trials_of_all(const Compared& compared,
                                                 const std::vector<std::string>& estimators,
                                                 const std::string& metric) {
  std::vector<std::vector<TrialKey>> all = compared.trials;
  for (std::size_t c = 0; c < all.size(); ++c) {
    std::erase_if(all[c], [&](const TrialKey& trial) {
      return std::ranges::any_of(estimators, [&](const std::string& estimator) {
        const RunRecord* run = done_run(compared, estimator, c, trial);
        return run == nullptr || !value_of(compared, *run, metric);
      });
    });
  }
  return all;
}

std::optional<TrialMean> mean_over(const Compared& compared, const std::string& estimator,
                                   const std::string& metric,
                                   const std::vector<std::vector<TrialKey>>& trials) {
  std::vector<ClusteredValues> cells;
  for (std::size_t c = 0; c < trials.size(); ++c) {
    auto values = values_in(compared, estimator, c, trials[c], metric);
    if (!values) return std::nullopt;
    cells.push_back(std::move(*values));
  }
  return mean_over_cells(cells);
}

std::optional<PairedDifference> difference_over(const Compared& compared, const std::string& one,
                                                const std::string& other, const std::string& metric,
                                                const std::vector<std::vector<TrialKey>>& trials) {
  std::vector<ClusteredValues> cells;
  DistinctValues pooled(metric);
  PairedDifference difference;
  for (std::size_t c = 0; c < trials.size(); ++c) {
    DistinctValues values(metric);
    for (const TrialKey& trial : trials[c]) {
      const RunRecord& a = *done_run(compared, one, c, trial);
      const RunRecord& b = *done_run(compared, other, c, trial);
      const double of_a = *value_of(compared, a, metric);
      const double of_b = *value_of(compared, b, metric);
      values.add(a, b, of_a, of_b);
      pooled.add(a, b, of_a, of_b);
    }
    difference.trials += trials[c].size();
    if (values.values().empty()) return std::nullopt;
    cells.push_back(values.values());
  }
  const TrialMean mean = mean_over_cells(cells);
  difference.mean = mean.mean;
  difference.interval = mean.interval;
  difference.is_over_surveys = pooled.values().size() > 1;
  const ClusteredValues tested = by_survey(cells, pooled.values());
  difference.signed_rank = *test_over_surveys(tested);
  difference.count = difference.is_over_surveys ? tested.size() : tested.begin()->second.size();
  return difference;
}

double excess(const Requirement& requirement, const Judgement& judgement) {
  if (!judgement.value) return std::numeric_limits<double>::infinity();
  const double over = decisive_end(requirement, *judgement.value) - requirement.bound;
  const double scale = requirement.bound == 0.0 ? 1.0 : std::abs(requirement.bound);
  return (requirement.is_upper_bound() ? over : -over) / scale;
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
  evidence.objective = mean_over(compared, estimator, query.objective, compared.trials);
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

}  // namespace fathom
