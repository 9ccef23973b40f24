#include "fathom/results/run_index.hpp"

#include <algorithm>
#include <set>

#include "fathom/estimation/estimator.hpp"

namespace fathom {
namespace {

std::string numbers_text(const std::vector<std::size_t>& numbers) {
  constexpr std::size_t kShown = 5;
  std::string text = numbers.size() == 1 ? "trial " : "trials ";
  for (std::size_t i = 0; i < std::min(numbers.size(), kShown); ++i) {
    text += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
  }
  if (numbers.size() > kShown) text += " and " + std::to_string(numbers.size() - kShown) + " more";
  return text;
}

}  // namespace

RunIndex::RunIndex(const ResultStore& store) : study_(store.study()), runs_(store.runs()) {
  for (const RunRecord& run : runs_) {
    by_estimator_[run.key.estimator][run.key.cell][run.key.trial] = &run;
  }
}

const RunIndex::Trials& RunIndex::of(const std::string& estimator, std::size_t cell) const {
  static const Trials kNone;
  const auto cells = by_estimator_.find(estimator);
  if (cells == by_estimator_.end()) return kNone;
  const auto trials = cells->second.find(cell);
  return trials == cells->second.end() ? kNone : trials->second;
}

bool RunIndex::has(const RunKey& key) const {
  return of(key.estimator, key.cell).contains(key.trial);
}

std::vector<std::size_t> RunIndex::common_trials(std::size_t cell) const {
  std::map<std::size_t, std::size_t> estimators_of_trial;
  for (const StudyEstimator& estimator : study_.estimators) {
    for (const auto& [trial, run] : of(estimator.name, cell)) ++estimators_of_trial[trial];
  }
  std::vector<std::size_t> common;
  for (const auto& [trial, count] : estimators_of_trial) {
    if (count == study_.estimators.size()) common.push_back(trial);
  }
  return common;
}

std::vector<std::string> RunIndex::metrics() const {
  std::set<std::string> names;
  for (const RunRecord& run : runs_) {
    for (const auto& [name, value] : run.metrics) names.insert(name);
  }
  return {names.begin(), names.end()};
}

int RunIndex::most_jobs(const std::vector<std::size_t>& cells) const {
  int most = 1;
  for (const RunRecord& run : runs_) {
    if (std::find(cells.begin(), cells.end(), run.key.cell) == cells.end()) continue;
    most = std::max(most, run.jobs);
  }
  return most;
}

std::string RunIndex::unfinished(const std::vector<std::size_t>& cells) const {
  std::size_t there = 0;
  std::vector<std::string> gaps;
  for (const std::size_t cell : cells) {
    for (const StudyEstimator& estimator : study_.estimators) {
      const Trials& trials = of(estimator.name, cell);
      there += trials.size();
      std::vector<std::size_t> missing;
      for (std::size_t trial = 0; trial < study_.trials; ++trial) {
        if (!trials.contains(trial)) missing.push_back(trial);
      }
      if (missing.empty()) continue;
      const bool all = missing.size() == study_.trials;
      gaps.push_back(estimator.name + " in " + study_.label_of(cell) + " (" +
                     (all ? "all" : numbers_text(missing)) + ")");
    }
  }
  if (gaps.empty()) return "";
  constexpr std::size_t kShown = 3;
  std::string text = "the study is not finished: " + std::to_string(there) + " of " +
                     std::to_string(cells.size() * study_.trials * study_.estimators.size()) +
                     " runs; missing: ";
  for (std::size_t i = 0; i < std::min(gaps.size(), kShown); ++i) {
    text += (i > 0 ? "; " : "") + gaps[i];
  }
  if (gaps.size() > kShown) text += "; and " + std::to_string(gaps.size() - kShown) + " gaps more";
  return text;
}

bool is_failed(const RunRecord& run) {
  if (run.key.estimator == kDeadReckoning) return false;
  return run.outcome != name_of(Outcome::converged) &&
         run.outcome != name_of(Outcome::iteration_limit);
}

}  // namespace fathom
