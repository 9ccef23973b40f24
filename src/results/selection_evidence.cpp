#include "selection_evidence.hpp"

#include <cmath>
#include <limits>

#include "cell_means.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/metrics.hpp"

namespace fathom {
namespace {

// The values of one metric in a cell; nothing where a run that is done has none, or where no run is
// done.
std::optional<ClusteredValues> values_in(const Compared& compared, const std::string& estimator,
                                         std::size_t c, const std::string& metric) {
  ClusteredValues values;
  const bool is_cost = is_cost_metric(metric);
  for (const TrialKey& trial : compared.trials[c]) {
    const RunRecord* run = done_run(compared, estimator, c, trial);
    if (run == nullptr) continue;
    if (is_cost && run->machine != compared.runs.cost_machine()) continue;
    const auto value = run->metrics.find(metric);
    if (value == run->metrics.end()) return std::nullopt;
    values[trial.survey].push_back(value->second);
  }
  if (values.empty()) return std::nullopt;
  return values;
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
  std::vector<ClusteredValues> cells;
  for (std::size_t c = 0; c < compared.cells.size(); ++c) {
    auto values = values_in(compared, estimator, c, metric);
    if (!values) return std::nullopt;
    cells.push_back(std::move(*values));
  }
  return mean_over_cells(cells);
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

}  // namespace fathom
