#include <algorithm>
#include <cmath>

#include "fathom/report/table.hpp"
#include "honesty_words.hpp"
#include "scaled_unit.hpp"
#include "verdict.hpp"

namespace fathom {
namespace {

constexpr double kSignificant = 0.05;

void add_few_draws(const CellResults& cell, std::vector<Doubt>& doubts) {
  const auto add = [&doubts](const std::string& text) { doubts.push_back({text, text}); };
  if (cell.trials < 2) {
    add("A single trial: there is no interval, and the order may be chance.");
  } else if (cell.repetition == Repetition::logs) {
    if (cell.trials < kFewSurveys) add("Only " + std::to_string(cell.trials) + " trials.");
  } else if (cell.surveys == 1) {
    add(limits_text(cell));
  } else if (cell.surveys < kFewSurveys) {
    add("Only " + std::to_string(cell.surveys) + " surveys: others may give another order.");
  }
}

// Where the interval and the test disagree. Of few pairs no p can be small: say so.
void add_disagreement(const Ranking& ranking, std::vector<Doubt>& doubts) {
  const std::size_t tests = ranking.estimators.size() - 1;
  std::vector<std::string> names;
  std::string limit;
  for (const RankedEstimator& one : ranking.estimators) {
    if (!one.is_told_apart() || !one.holm_p || *one.holm_p < kSignificant) continue;
    names.push_back(one.name + " (p = " + format_number(*one.holm_p, 2) + ")");
    const std::size_t count = one.difference->count;
    const double least = static_cast<double>(tests) * std::exp2(1.0 - static_cast<double>(count));
    if (least < kSignificant || !limit.empty()) continue;
    limit = " With " + counted(count, one.difference->is_over_surveys ? "survey" : "trial") +
            " and " + counted(tests, "comparison") + " no p is below " +
            format_number(std::min(1.0, least), 2) + ".";
  }
  if (names.empty()) return;
  doubts.push_back(
      {"The interval of the difference excludes 0, but the adjusted p is above 0.05: " +
           listed(names) + "." + limit,
       "an interval excludes 0 where the adjusted p is above 0.05"});
}

void add_overconfidence(const CellResults& cell, std::vector<Doubt>& doubts) {
  for (const std::string kind : {"Overconfident", "Underconfident"}) {
    std::vector<std::string> names;
    std::string cause;
    for (const EstimatorResults& one : cell.estimators) {
      const bool is_meant = !one.words.empty() && one.words.front().starts_with(kind);
      if (one.name == kDeadReckoning || !is_meant) continue;
      const MetricSummary& anees = one.consistency.at("anees");
      names.push_back(one.name + " (ANEES " + quantity(anees.moments.mean, anees.interval, "") +
                      ")");
      if (cause.empty() && one.words.size() > 1) cause = " " + one.words[1];
    }
    if (names.empty()) continue;
    doubts.push_back({kind + ", where 1 is expected: " + listed(names) + "." + cause,
                      "estimators are " + std::string(kind == "Overconfident" ? "overconfident"
                                                                              : "underconfident")});
  }
}

// Where no words have named it as a cause. It is a figure of the registrations, so that of one
// estimator stands for all.
void add_correlation(const CellResults& cell, std::vector<Doubt>& doubts) {
  if (std::ranges::any_of(cell.estimators, [](const auto& one) { return !one.words.empty(); })) {
    return;
  }
  for (const EstimatorResults& one : cell.estimators) {
    const auto found = one.consistency.find("picture_error_correlation");
    if (found == one.consistency.end()) continue;
    const auto& [figures, surveys, interval] = found->second;
    if (!interval || interval->low <= 0.0) continue;
    doubts.push_back({"Registrations of one picture share errors (correlation " +
                          quantity(figures.mean, interval, "") +
                          "), which estimators take as independent.",
                      "registrations of one picture share errors"});
    return;
  }
}

void add_optimum(const CellResults& cell, std::vector<Doubt>& doubts) {
  std::vector<std::string> names;
  for (const EstimatorResults& one : cell.estimators) {
    if (!is_off_the_optimum(one.consistency)) continue;
    const MetricSummary& gap = one.consistency.at("chi2_gap");
    names.push_back(one.name + " by " + quantity(gap.moments.mean, gap.interval, ""));
  }
  if (names.empty()) return;
  doubts.push_back({"F above the optimum of the measurements: " + listed(names) + ".",
                    "estimates are not at the optimum of the measurements"});
}

void add_loops(const CellResults& cell, std::vector<Doubt>& doubts) {
  std::vector<std::string> names;
  for (const EstimatorResults& one : cell.estimators) {
    if (runs_without_loops(one) > 0) names.push_back(one.name);
  }
  if (names.empty()) return;
  doubts.push_back(
      {"The means of " + listed(names) +
           " hold runs without loop closures, which are no better than dead reckoning.",
       "means hold runs without loop closures"});
}

// The reference that selected the loops may be one of those that are compared.
void add_reference(const CellResults& cell, std::vector<Doubt>& doubts) {
  if (!cell.selected_by.ends_with(", a contender")) return;
  const std::string text =
      "Loops were selected by " + cell.selected_by + ": the others replay what suited it.";
  doubts.push_back({text, text});
}

// Over the trials that both did.
void add_baseline(const CellResults& cell, const Ranking& ranking, std::vector<Doubt>& doubts) {
  const auto of = [&cell](const std::string& name) {
    return std::ranges::find(cell.estimators, name, &EstimatorResults::name);
  };
  const auto baseline = of(kDeadReckoning);
  if (baseline == cell.estimators.end() || !baseline->metrics.contains(ranking.metric)) return;
  const auto difference = difference_between(*baseline, *of(ranking.best().name), ranking.metric);
  if (!difference || !difference->interval) return;
  const bool is_lower = described(ranking.metric).better == Better::lower;
  if (is_lower ? difference->interval->low > 0.0 : difference->interval->high < 0.0) return;
  doubts.push_back(
      {"The best is not told apart from dead reckoning, whose difference to it is " +
           quantity(difference->mean, difference->interval, described(ranking.metric).unit) + ".",
       "the best is not told apart from dead reckoning"});
}

void add_jobs(const CellResults& cell, std::vector<Doubt>& doubts) {
  if (cell.jobs.empty() || *cell.jobs.rbegin() <= 1) return;
  const std::string text = "Costs were measured with " + counts_text(cell.jobs) +
                           " jobs at a time; they are comparable at 1 alone.";
  doubts.push_back({text, text});
}

void add_machines(const CellResults& cell, std::vector<Doubt>& doubts) {
  if (!cell.machines.empty()) doubts.push_back({cell.machines, cell.machines});
}

}  // namespace

std::vector<Doubt> doubts_of(const CellResults& cell, const CellVerdict& verdict) {
  std::vector<Doubt> doubts;
  add_few_draws(cell, doubts);
  if (verdict.ranking) {
    add_disagreement(*verdict.ranking, doubts);
    add_baseline(cell, *verdict.ranking, doubts);
  }
  add_overconfidence(cell, doubts);
  add_correlation(cell, doubts);
  add_optimum(cell, doubts);
  add_loops(cell, doubts);
  add_reference(cell, doubts);
  if (!verdict.cost.empty()) {
    add_jobs(cell, doubts);
    add_machines(cell, doubts);
  }
  return doubts;
}

}  // namespace fathom
