#include "contenders.hpp"

#include <algorithm>
#include <fmt/format.h>

namespace fathom {
namespace {

using Trials = std::set<TrialKey>;

void keep_those_of(const Trials& others, Trials& trials) {
  std::erase_if(trials, [&](const TrialKey& trial) { return !others.contains(trial); });
}

// The trials to rank by: those that all have run and one has the metric in.
Trials trials_of(const std::vector<const EstimatorResults*>& all, const Metric& metric) {
  Trials trials;
  for (const EstimatorResults* one : all) trials.merge(trials_with(*one, metric.name));
  for (const EstimatorResults* one : all) {
    Trials own;
    for (const RunRecord& run : one->runs) own.insert(run.key.trial_key());
    keep_those_of(metric.is_cost ? trials_with(*one, metric.name) : own, trials);
  }
  return trials;
}

}  // namespace

bool is_ranked(const EstimatorResults& one, const std::string& metric,
               const std::vector<std::string>& names) {
  return one.name != kDeadReckoning && one.failures() == 0 && one.metrics.contains(metric) &&
         (names.empty() || std::ranges::find(names, one.name) != names.end());
}

std::vector<Contender> contenders_of(const CellResults& cell, const Metric& metric,
                                     const std::vector<std::string>& names,
                                     std::vector<PartlyMeasured>& left_out) {
  std::vector<const EstimatorResults*> all;
  for (const EstimatorResults& one : cell.estimators) {
    if (is_ranked(one, metric.name, names)) all.push_back(&one);
  }
  const Trials trials = trials_of(all, metric);
  std::vector<Contender> order;
  for (const EstimatorResults* one : all) {
    Trials without = trials;
    const Trials own = trials_with(*one, metric.name);
    std::erase_if(without, [&](const TrialKey& trial) { return own.contains(trial); });
    if (trials.empty()) continue;
    if (without.empty()) {
      order.push_back({one, summary_over(*one, metric.name, trials)});
    } else {
      left_out.push_back({one->name, without.size(), trials.size()});
    }
  }
  std::ranges::stable_sort(order, [&](const Contender& a, const Contender& b) {
    return metric.better == Better::lower ? a.mean() < b.mean() : a.mean() > b.mean();
  });
  return order;
}

std::string nobody_is_ranked_text(const CellResults& cell, const std::string& metric) {
  bool is_any_sound = false;
  bool has_any = false;
  for (const EstimatorResults& one : cell.estimators) {
    if (one.name == kDeadReckoning || one.failures() > 0) continue;
    is_any_sound = true;
    has_any = has_any || one.metrics.contains(metric);
  }
  if (!is_any_sound) return "No estimator is ranked: none did all its runs.";
  const std::string label = described(metric).label;
  if (!has_any) return fmt::format("No estimator is ranked: no run here has a {}.", label);
  return fmt::format("No estimator is ranked: they have the {} in different trials.", label);
}

}  // namespace fathom
