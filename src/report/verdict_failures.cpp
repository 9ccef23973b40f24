#include "verdict_failures.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "fathom/core/text.hpp"
#include "verdict.hpp"
#include "verdict_answer.hpp"

namespace fathom {
namespace {

std::string outcomes_text(const EstimatorResults& one) {
  std::vector<std::string> parts;
  for (const auto& [outcome, count] : one.outcomes) {
    if (outcome == "converged" || outcome == "iteration_limit") continue;
    parts.push_back(std::to_string(count) + " " + worded(outcome));
  }
  return parts.empty() ? "" : " (" + listed(parts) + ")";
}

// "ekf: 3 of 12 runs are missing."
std::string missing_text(const std::string& estimator, std::size_t missing, std::size_t wanted) {
  return fmt::format("{}: {} of {} are missing.", estimator, missing, counted(wanted, "run"));
}

}  // namespace

std::vector<std::string> failures_of(const CellResults& cell, const StudyDescription& study) {
  std::vector<std::string> sentences;
  const std::size_t wanted = study.surveys * study.trials;
  for (const EstimatorResults& one : cell.estimators) {
    if (one.name == kDeadReckoning) continue;
    const std::string of_runs = " of " + counted(one.runs.size(), "run");
    const auto add = [&](std::size_t count, const std::string& verb, const std::string& end) {
      if (count == 0) return;
      sentences.push_back(one.name + " " + verb + " in " + std::to_string(count) + of_runs + end);
    };
    add(one.failures(), "failed", outcomes_text(one) + " and is not ranked.");
    const auto limit = one.outcomes.find("iteration_limit");
    add(limit == one.outcomes.end() ? 0 : limit->second, "stopped at its iteration limit",
        "; these count as done.");
    add(runs_without_loops(one), "closed no loop", ".");
    if (one.runs.size() < wanted) {
      sentences.push_back(missing_text(one.name, wanted - one.runs.size(), wanted));
    }
  }
  for (const StudyEstimator& one : study.estimators) {
    if (std::ranges::find(cell.estimators, one.name, &EstimatorResults::name) ==
        cell.estimators.end()) {
      sentences.push_back(missing_text(one.name, wanted, wanted));
    }
  }
  return sentences;
}

void add_empty_cells(const StudyResults& results, std::vector<std::string>& sentences) {
  constexpr std::size_t kNamed = 3;
  std::vector<std::string> named = results.empty_cells;
  if (named.empty()) return;
  const std::size_t count = named.size();
  if (count > kNamed + 1) {
    named.resize(kNamed);
    named.push_back("and " + std::to_string(count - kNamed) + " more");
  }
  sentences.push_back(fmt::format(
      "No run yet in {}: {}.", of_cells(count, results.cells.size() + count), joined(named, "; ")));
}

std::vector<std::string> failures_of(const StudyResults& results) {
  std::vector<std::string> sentences;
  struct Count {
    std::size_t failed = 0;
    std::size_t without_loops = 0;
    std::size_t runs = 0;
    std::size_t cells_failed = 0;
    std::size_t cells_without = 0;
  };
  std::map<std::string, Count> counts;
  std::vector<std::string> order;
  for (const StudyEstimator& one : results.study.estimators) {
    order.push_back(one.name);
    counts[one.name] = {};
  }
  for (const CellResults& cell : results.cells) {
    for (const EstimatorResults& one : cell.estimators) {
      if (one.name == kDeadReckoning) continue;
      if (!counts.contains(one.name)) order.push_back(one.name);
      Count& count = counts[one.name];
      count.failed += one.failures();
      count.without_loops += runs_without_loops(one);
      count.runs += one.runs.size();
      count.cells_failed += one.failures() > 0 ? 1 : 0;
      count.cells_without += runs_without_loops(one) > 0 ? 1 : 0;
    }
  }
  const std::size_t wanted = (results.cells.size() + results.empty_cells.size()) *
                             results.study.surveys * results.study.trials;
  for (const std::string& name : order) {
    const Count& count = counts[name];
    const auto add = [&](std::size_t runs, std::size_t cells, const std::string& verb,
                         const std::string& end) {
      if (runs == 0) return;
      sentences.push_back(fmt::format("{} {} in {} of {}, in {}{}", name, verb, runs,
                                      counted(count.runs, "run"),
                                      of_cells(cells, results.cells.size()), end));
    };
    add(count.failed, count.cells_failed, "failed", ", where it is not ranked.");
    add(count.without_loops, count.cells_without, "closed no loop", ".");
    if (count.runs < wanted) {
      sentences.push_back(missing_text(name, wanted - count.runs, wanted));
    }
  }
  add_empty_cells(results, sentences);
  return sentences;
}

}  // namespace fathom
