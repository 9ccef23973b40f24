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

const Contender* Contenders::find(const std::string& estimator) const {
  const auto found = std::ranges::find_if(
      order, [&](const Contender& entry) { return entry.one->name == estimator; });
  return found == order.end() ? nullptr : &*found;
}

bool is_ranked(const EstimatorResults& one, const std::string& metric,
               const std::vector<std::string>& names) {
  return one.name != kDeadReckoning && one.failures() == 0 && !trials_with(one, metric).empty() &&
         (names.empty() || std::ranges::find(names, one.name) != names.end());
}

Contenders contenders_of(const CellResults& cell, const std::string& metric,
                         const std::vector<std::string>& names) {
  const Metric catalogued = described(metric);
  if (catalogued.better == Better::neither || !no_ranking_text(cell, metric).empty()) return {};
  std::vector<const EstimatorResults*> all;
  for (const EstimatorResults& one : cell.estimators) {
    if (is_ranked(one, metric, names)) all.push_back(&one);
  }
  Contenders found;
  found.trials = trials_of(all, catalogued);
  if (found.trials.empty()) return found;
  for (const EstimatorResults* one : all) {
    const Trials own = trials_with(*one, metric);
    const auto without = static_cast<std::size_t>(std::ranges::count_if(
        found.trials, [&](const TrialKey& trial) { return !own.contains(trial); }));
    if (without == 0) {
      found.order.push_back({one, mean_over(*one, metric, found.trials)});
    } else {
      found.left_out.push_back({one->name, without, found.trials.size()});
    }
  }
  std::ranges::stable_sort(found.order, [&](const Contender& a, const Contender& b) {
    return catalogued.better == Better::lower ? a.mean < b.mean : a.mean > b.mean;
  });
  return found;
}

std::string nobody_is_ranked_text(const CellResults& cell, const std::string& metric) {
  bool is_any_sound = false;
  bool has_any = false;
  for (const EstimatorResults& one : cell.estimators) {
    if (one.name == kDeadReckoning || one.failures() > 0) continue;
    is_any_sound = true;
    has_any = has_any || !trials_with(one, metric).empty();
  }
  if (!is_any_sound) return "No estimator is ranked: none did all its runs.";
  const std::string label = described(metric).label;
  if (!has_any) return fmt::format("No estimator is ranked: no run here has a {}.", label);
  return fmt::format("No estimator is ranked: they have the {} in different trials.", label);
}

}  // namespace fathom
