#include "study_results.hpp"

namespace fathom {
namespace {

std::string worded(std::string name) {
  for (char& letter : name) letter = letter == '_' ? ' ' : letter;
  return name;
}

}  // namespace

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

std::string outcome_text(const EstimatorResults& estimator, std::size_t trials_wanted) {
  std::string text =
      std::to_string(estimator.done) + "/" + std::to_string(estimator.runs.size()) + " done";
  for (const auto& [name, count] : estimator.outcomes) {
    if (name == "converged") continue;
    text += ", " + std::to_string(count) + " " +
            (name == "iteration_limit" ? "at iteration limit" : worded(name));
  }
  if (estimator.runs.size() < trials_wanted) {
    text += ", " + std::to_string(trials_wanted - estimator.runs.size()) + " not run";
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
    text += (text.empty() ? "; failed: " : ", ") + one.name + " " + std::to_string(one.failures()) +
            "/" + std::to_string(one.runs.size());
  }
  return text;
}

std::string cell_caption(const CellResults& cell) {
  std::string text = cell.label + ": ";
  if (!cell.association.empty()) text += "association " + cell.association + ", ";
  if (!cell.selected_by.empty()) text += "loops selected by " + cell.selected_by + ", ";
  if (!cell.alignment.empty()) text += "alignment " + cell.alignment + ", ";
  text += "n = " + std::to_string(cell.trials);
  if (!cell.jobs.empty()) text += ", jobs " + counts_text(cell.jobs);
  return text;
}

}  // namespace fathom
