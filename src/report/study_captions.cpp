#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <set>

#include "fathom/core/text.hpp"
#include "fathom/results/run_index.hpp"
#include "study_results.hpp"

namespace fathom {
std::string worded(std::string name) {
  for (char& letter : name) letter = letter == '_' ? ' ' : letter;
  return name;
}

std::size_t runs_without_loops(const EstimatorResults& estimator) {
  if (estimator.name == kDeadReckoning) return 0;
  return static_cast<std::size_t>(std::ranges::count_if(estimator.runs, [](const RunRecord& run) {
    const auto loops = run.metrics.find("loop_closures");
    return !is_failed(run) && loops != run.metrics.end() && loops->second == 0.0;
  }));
}

std::string display_name(const std::string& estimator) {
  return estimator == kDeadReckoning ? "dead reckoning" : estimator;
}

Metric described(const std::string& metric) {
  if (auto known = find_metric(metric)) return *std::move(known);
  Metric unknown;
  unknown.name = metric;
  unknown.label = worded(metric);
  return unknown;
}

std::string outcome_text(const EstimatorResults& estimator, const StudyDescription& study) {
  const std::size_t wanted = study.surveys * study.trials;
  std::string text = fmt::format("{}/{} done", estimator.done, estimator.runs.size());
  for (const auto& [name, count] : estimator.outcomes) {
    if (name == "converged") continue;
    text += fmt::format(", {} {}", count,
                        name == "iteration_limit" ? "at iteration limit" : worded(name));
  }
  if (const std::size_t count = runs_without_loops(estimator); count > 0) {
    text += ", " + std::to_string(count) + " without loops";
  }
  if (estimator.runs.size() < wanted) {
    text += ", " + std::to_string(wanted - estimator.runs.size()) + " not run";
  }
  return text;
}

std::string counts_text(const std::set<int>& jobs) {
  std::string text;
  for (const int count : jobs) text += (text.empty() ? "" : ", ") + std::to_string(count);
  return text;
}

std::string failures_text(const CellResults& cell) {
  std::string text;
  for (const EstimatorResults& one : cell.estimators) {
    if (one.failures() == 0) continue;
    text += fmt::format("{}{} {}/{}", text.empty() ? "; failed: " : ", ", one.name, one.failures(),
                        one.runs.size());
  }
  return text;
}

std::vector<std::string> caption_parts(const CellResults& cell) {
  std::vector<std::string> parts;
  if (!cell.association.empty()) parts.push_back("association " + cell.association);
  if (!cell.selected_by.empty()) parts.push_back("loops selected by " + cell.selected_by);
  if (!cell.alignment.empty()) parts.push_back("alignment " + cell.alignment);
  parts.push_back(cell.repeats);
  if (!cell.jobs.empty()) parts.push_back("jobs " + counts_text(cell.jobs));
  return parts;
}

std::string cell_caption(const CellResults& cell) {
  return cell.label + ": " + joined(caption_parts(cell), ", ");
}

TrialKey first_trial(const CellResults& cell) {
  TrialKey first = cell.estimators.front().runs.front().key.trial_key();
  for (const EstimatorResults& one : cell.estimators) {
    first = std::min(first, one.runs.front().key.trial_key());
  }
  return first;
}

std::string example_text(const CellResults& cell, const TrialKey& trial) {
  const std::string text = "trial " + std::to_string(trial.trial);
  if (cell.repetition != Repetition::surveys) return text;
  return fmt::format("survey {}, {}", trial.survey, text);
}

std::string repeats_there(const StudyDescription& study, const CellResults& cell) {
  const std::string text = repeats_text(cell.repetition, study.surveys, study.trials);
  const std::size_t all = study.surveys * study.trials;
  return cell.trials < all ? fmt::format("{} ({} of {})", text, cell.trials, all) : text;
}

std::string repeats_of(const std::vector<const CellResults*>& cells) {
  std::vector<std::string> all;
  for (const CellResults* cell : cells) {
    if (cell != nullptr && std::ranges::find(all, cell->repeats) == all.end()) {
      all.push_back(cell->repeats);
    }
  }
  return joined(all, " or ");
}

std::string intervals_text(const StudyResults& results) {
  const auto has = [&results](auto property) {
    return std::ranges::any_of(results.cells, property);
  };
  if (!has([](const CellResults& cell) { return cell.trials > 1; })) return "";
  if (!has([](const CellResults& cell) { return cell.surveys > 1; })) {
    return "Means over the trials that were done, with the 95 % bootstrap interval of the mean.";
  }
  return "Means over the surveys of the mean of each one's done trials, with the 95 % interval "
         "of the mean by a bootstrap over surveys and their trials.";
}

std::string machines_text(const StudyResults& results) {
  if (results.machines.size() < 2) return "";
  std::size_t runs = 0;
  for (const auto& [machine, count] : results.machines) runs += count;
  const std::string& shown = results.cost_machine;
  return fmt::format(
      "Costs are of {} ({} of {} runs); those of other processors are not averaged with them.",
      shown.empty() ? "an unknown processor" : shown, results.machines.at(shown), runs);
}

std::string limits_text(const CellResults& cell) {
  if (cell.surveys > 1 || cell.trials < 2) return "";
  std::string text = limits_of_one_survey(cell.repetition);
  if (text.empty()) return "";
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + ".";
}

}  // namespace fathom
