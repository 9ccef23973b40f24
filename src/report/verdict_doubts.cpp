#include <algorithm>
#include <cmath>

#include "doubts.hpp"
#include "honesty_words.hpp"
#include "verdict.hpp"

namespace fathom {
namespace {

// Of the trials that are ranked.
std::optional<Doubt> few_draws(const CellResults& cell, const CellVerdict& verdict) {
  std::size_t trials = cell.trials;
  std::size_t surveys = cell.surveys;
  if (verdict.ranking) {
    trials = verdict.ranking->trials.size();
    surveys = verdict.ranking->best().summary.surveys;
  }
  if (trials < 2) return doubt::SingleTrial{};
  if (verdict.ranking && verdict.ranking->repeats_one_result) return doubt::OneResult{trials};
  if (cell.repetition == Repetition::logs) {
    if (trials < kFewSurveys) return doubt::FewTrials{trials};
  } else if (surveys == 1) {
    return doubt::OneSurvey{limits_text(cell)};
  } else if (surveys < kFewSurveys) {
    return doubt::FewSurveys{surveys};
  }
  return std::nullopt;
}

std::optional<Doubt> wrong_confidence(const CellResults& cell, bool is_overconfident) {
  doubt::WrongConfidence found{is_overconfident, {}, {}};
  for (const EstimatorResults& one : cell.estimators) {
    if (one.name == kDeadReckoning || !one.honesty) continue;
    if (one.honesty->is_overconfident != is_overconfident) continue;
    found.anees.push_back({one.name, one.consistency.at("anees")});
    found.causes.push_back(cause_words(one));
  }
  if (found.anees.empty()) return std::nullopt;
  return found;
}

// Where it has not been named as a cause. It is a figure of the registrations, less what an
// estimator estimates of it, so that of one that takes them as independent stands for all those.
// Trials of one survey share its registrations: an interval over them says nothing.
std::optional<Doubt> correlation(const CellResults& cell) {
  if (cell.repetition != Repetition::logs && cell.surveys < 2) return std::nullopt;
  doubt::Correlation doubt;
  for (const EstimatorResults& one : cell.estimators) {
    if (one.honesty && one.honesty->cause == HonestyCause::shared_errors) continue;
    const auto found = one.consistency.find("picture_error_correlation");
    if (found == one.consistency.end()) continue;
    const auto& interval = found->second.interval;
    if (!interval || !(interval->low > 0.0)) continue;
    const auto states = one.consistency.find("estimates_shared_errors");
    const bool is_told = states != one.consistency.end();
    if (is_told && states->second.moments.mean == 1.0) {
      // What of it is of keypoints is allowed for: no matter where it is not overconfident.
      if (!one.honesty || !one.honesty->is_overconfident) continue;
      if (doubt.beyond.empty()) doubt.left = found->second;
      doubt.beyond.push_back(one.name);
      continue;
    }
    if (doubt.estimators.empty()) doubt.correlation = found->second;
    doubt.estimators.push_back(one.name);
    doubt.is_told = is_told;
  }
  if (doubt.estimators.empty() && doubt.beyond.empty()) return std::nullopt;
  return doubt;
}

std::optional<Doubt> off_the_optimum(const CellResults& cell) {
  doubt::OffTheOptimum found;
  for (const EstimatorResults& one : cell.estimators) {
    if (!is_off_the_optimum(one.consistency, one.considers_shared_errors)) continue;
    found.gaps.push_back({one.name, one.consistency.at("chi2_gap")});
  }
  if (found.gaps.empty()) return std::nullopt;
  return found;
}

std::optional<double> finite_mean_of(const EstimatorResults& one, const std::string& metric) {
  double sum = 0.0;
  std::size_t count = 0;
  for (const RunRecord& run : one.runs) {
    const auto found = run.metrics.find(metric);
    if (found == run.metrics.end() || !std::isfinite(found->second)) continue;
    sum += found->second;
    ++count;
  }
  if (count == 0) return std::nullopt;
  return sum / static_cast<double>(count);
}

std::optional<doubt::FrontEnd> front_end_of(const CellResults& cell) {
  for (const EstimatorResults& one : cell.estimators) {
    const auto tried = finite_mean_of(one, "registrations_tried");
    const auto registered = finite_mean_of(one, "registrations");
    if (tried && registered) return doubt::FrontEnd{*tried, *registered};
  }
  return std::nullopt;
}

std::optional<Doubt> without_loops(const CellResults& cell) {
  doubt::WithoutLoops found;
  for (const EstimatorResults& one : cell.estimators) {
    if (runs_without_loops(one) > 0) found.estimators.push_back(one.name);
  }
  if (found.estimators.empty()) return std::nullopt;
  found.front_end = front_end_of(cell);
  return found;
}

// By ground truth. Where candidates were left out, a budget explains it.
std::optional<Doubt> few_loops(const CellResults& cell) {
  constexpr double kFew = 0.5;
  std::optional<double> recall;
  for (const EstimatorResults& one : cell.estimators) {
    if (finite_mean_of(one, "registrations_left_out").value_or(0.0) > 0.0) return std::nullopt;
    const auto mean = finite_mean_of(one, "loop_recall");
    if (mean && one.name != kDeadReckoning) recall = std::max(recall.value_or(0.0), *mean);
  }
  if (!recall || *recall >= kFew) return std::nullopt;
  return doubt::FewLoops{*recall, front_end_of(cell)};
}

std::optional<Doubt> misfit(const CellResults& cell) {
  const auto per_degree = optimum_per_degree(cell);
  if (!is_misfit(per_degree)) return std::nullopt;
  return doubt::Misfit{*per_degree};
}

// An estimator waits for nothing but a processor.
std::optional<Doubt> busy_machine(const CellResults& cell) {
  constexpr double kLeastShare = 0.8;
  doubt::BusyMachine found;
  for (const EstimatorResults& one : cell.estimators) {
    const auto processor_ms = finite_mean_of(one, "cpu_ms");
    const auto total_ms = finite_mean_of(one, "total_ms");
    if (!processor_ms || !total_ms || *processor_ms >= kLeastShare * *total_ms) continue;
    found.share = std::min(found.share, *processor_ms / *total_ms);
    found.estimators.push_back(one.name);
  }
  if (found.estimators.empty()) return std::nullopt;
  return found;
}

// Over the trials that both did.
std::optional<Doubt> baseline_as_good(const CellResults& cell, const Ranking& ranking) {
  const auto of = [&cell](const std::string& name) {
    return std::ranges::find(cell.estimators, name, &EstimatorResults::name);
  };
  const auto baseline = of(kDeadReckoning);
  if (baseline == cell.estimators.end() || !baseline->metrics.contains(ranking.metric)) {
    return std::nullopt;
  }
  const auto difference = difference_between(*baseline, *of(ranking.best().name), ranking.metric,
                                             {}, 1.0, &ranking.trials);
  if (!difference || !difference->interval) return std::nullopt;
  const bool is_lower = described(ranking.metric).better == Better::lower;
  if (is_lower ? difference->interval->low > 0.0 : difference->interval->high < 0.0) {
    return std::nullopt;
  }
  const bool is_worse =
      is_lower ? difference->interval->high < 0.0 : difference->interval->low > 0.0;
  return doubt::BaselineAsGood{*difference, ranking.metric, is_worse};
}

}  // namespace

std::vector<Doubt> doubts_of(const CellResults& cell, const CellVerdict& verdict) {
  std::vector<Doubt> doubts;
  const auto add = [&doubts](const std::optional<Doubt>& found) {
    if (found) doubts.push_back(*found);
  };
  add(few_draws(cell, verdict));
  if (verdict.ranking) add(baseline_as_good(cell, *verdict.ranking));
  add(wrong_confidence(cell, true));
  add(wrong_confidence(cell, false));
  add(correlation(cell));
  add(off_the_optimum(cell));
  add(without_loops(cell));
  add(few_loops(cell));
  add(misfit(cell));
  if (cell.contender_selects) add(doubt::ContenderSelects{cell.selected_by});
  if (!verdict.cost.empty()) {
    if (!cell.jobs.empty() && *cell.jobs.rbegin() > 1) add(doubt::SeveralJobs{cell.jobs});
    add(busy_machine(cell));
    if (!cell.machines.empty()) add(doubt::SeveralMachines{cell.machines});
  }
  return doubts;
}

}  // namespace fathom
