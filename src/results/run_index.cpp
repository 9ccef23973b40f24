#include "fathom/results/run_index.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <set>
#include <tuple>

#include "fathom/estimation/estimator.hpp"

namespace fathom {
namespace {

// "trials 3, 4 of survey 1", survey by survey; of a study of one survey its trials alone.
std::string trials_text(const std::vector<TrialKey>& trials, bool one_survey) {
  constexpr std::size_t kShown = 5;
  std::string text;
  for (std::size_t i = 0; i < std::min(trials.size(), kShown);) {
    std::size_t end = i + 1;
    const auto is_same = [&] { return trials[end].survey == trials[i].survey; };
    while (end < std::min(trials.size(), kShown) && is_same()) ++end;
    text += (text.empty() ? "" : ", ") + std::string(end - i == 1 ? "trial " : "trials ");
    for (std::size_t j = i; j < end; ++j) {
      text += (j > i ? ", " : "") + std::to_string(trials[j].trial);
    }
    if (!one_survey) text += " of survey " + std::to_string(trials[i].survey);
    i = end;
  }
  if (trials.size() > kShown) text += " and " + std::to_string(trials.size() - kShown) + " more";
  return text;
}

// Asked for by the study and not there.
std::vector<TrialKey> missing_of(const RunIndex::Trials& there, const StudyDescription& study) {
  std::vector<TrialKey> missing;
  for (std::size_t survey = 0; survey < study.surveys; ++survey) {
    for (std::size_t trial = 0; trial < study.trials; ++trial) {
      if (!there.contains({survey, trial})) missing.push_back({survey, trial});
    }
  }
  return missing;
}

// Dead reckoning is stored without a log: it is of that of its trial, which tells what repeats it.
// Runs are ordered: those of a trial lie together, dead reckoning first.
void tell_logs_of_dead_reckoning(std::vector<RunRecord>& runs) {
  const auto place = [](const RunRecord& run) {
    return std::tuple(run.key.cell, run.key.survey, run.key.trial);
  };
  for (auto run = runs.begin(); run != runs.end(); ++run) {
    if (run->key.estimator != kDeadReckoning) continue;
    const auto of_log = std::find_if(run, runs.end(), [&](const RunRecord& other) {
      return place(other) != place(*run) || !other.log_hash.empty();
    });
    if (of_log != runs.end() && place(*of_log) == place(*run)) run->log_hash = of_log->log_hash;
  }
}

}  // namespace

RunIndex::RunIndex(const ResultStore& store) : study_(store.study()), runs_(store.runs()) {
  tell_logs_of_dead_reckoning(runs_);
  for (const RunRecord& run : runs_) {
    by_estimator_[run.key.estimator][run.key.cell][run.key.trial_key()] = &run;
    if (run.key.estimator != kDeadReckoning) ++machines_[run.machine];
  }
  std::size_t most = 0;
  for (const auto& [machine, count] : machines_) {
    if (count <= most) continue;
    cost_machine_ = machine;
    most = count;
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
  return of(key.estimator, key.cell).contains(key.trial_key());
}

std::vector<TrialKey> RunIndex::common_trials(std::size_t cell) const {
  std::map<TrialKey, std::size_t> estimators_of_trial;
  for (const StudyEstimator& estimator : study_.estimators) {
    for (const auto& [trial, run] : of(estimator.name, cell)) ++estimators_of_trial[trial];
  }
  std::vector<TrialKey> common;
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
  const std::size_t wanted = study_.surveys * study_.trials;
  std::size_t there = 0;
  std::vector<std::string> gaps;
  for (const std::size_t cell : cells) {
    for (const StudyEstimator& estimator : study_.estimators) {
      const Trials& trials = of(estimator.name, cell);
      there += trials.size();
      const std::vector<TrialKey> missing = missing_of(trials, study_);
      if (missing.empty()) continue;
      const bool all = missing.size() == wanted;
      gaps.push_back(fmt::format("{} in {} ({})", estimator.name, study_.label_of(cell),
                                 all ? "all" : trials_text(missing, study_.surveys == 1)));
    }
  }
  if (gaps.empty()) return "";
  constexpr std::size_t kShown = 3;
  std::string text = fmt::format("the study is not finished: {} of {} runs; missing: ", there,
                                 cells.size() * wanted * study_.estimators.size());
  for (std::size_t i = 0; i < std::min(gaps.size(), kShown); ++i) {
    text += (i > 0 ? "; " : "") + gaps[i];
  }
  if (gaps.size() > kShown) text += "; and " + std::to_string(gaps.size() - kShown) + " gaps more";
  return text;
}

std::string repeats_text(Repetition repetition, const std::vector<TrialKey>& trials) {
  std::map<std::size_t, std::size_t> trials_of_survey;
  std::size_t most = 0;
  for (const TrialKey& trial : trials) most = std::max(most, ++trials_of_survey[trial.survey]);
  const std::size_t all = trials_of_survey.size() * most;
  const std::string text = repeats_text(repetition, trials_of_survey.size(), most);
  if (trials.size() == all) return text;
  return fmt::format("{} ({} of {})", text, trials.size(), all);
}

bool is_failed(const RunRecord& run) {
  if (run.key.estimator == kDeadReckoning) return false;
  return run.outcome != name_of(Outcome::converged) &&
         run.outcome != name_of(Outcome::iteration_limit);
}

}  // namespace fathom
