#include <algorithm>
#include <cmath>

#include "fathom/core/text.hpp"
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

// ": of 610 candidate pairs 0 registered"; empty of a pose graph.
std::string front_end_text(const CellResults& cell) {
  for (const EstimatorResults& one : cell.estimators) {
    const auto tried = finite_mean_of(one, "registrations_tried");
    const auto found = finite_mean_of(one, "registrations");
    if (!tried || !found) continue;
    if (*tried == 0.0) {
      return ": there were no candidate pairs; 'fathom check' of the data says what to expect";
    }
    return ": of " + short_number(*tried, 4) + " candidate pairs a trial " +
           short_number(*found, 4) + " registered";
  }
  return {};
}

void add_loops(const CellResults& cell, std::vector<Doubt>& doubts) {
  std::vector<std::string> names;
  for (const EstimatorResults& one : cell.estimators) {
    if (runs_without_loops(one) > 0) names.push_back(one.name);
  }
  if (names.empty()) return;
  doubts.push_back({"The means of " + listed(names) +
                        " hold runs without loop closures, which are no better than dead "
                        "reckoning" +
                        front_end_text(cell) + ".",
                    "means hold runs without loop closures"});
}

// By ground truth. Where candidates were left out, a budget explains it.
void add_few_loops(const CellResults& cell, std::vector<Doubt>& doubts) {
  constexpr double kFew = 0.5;
  std::optional<double> recall;
  for (const EstimatorResults& one : cell.estimators) {
    if (finite_mean_of(one, "registrations_left_out").value_or(0.0) > 0.0) return;
    const auto mean = finite_mean_of(one, "loop_recall");
    if (mean && one.name != kDeadReckoning) recall = std::max(recall.value_or(0.0), *mean);
  }
  if (!recall || *recall >= kFew) return;
  doubts.push_back({"Of the pairs of keyframes that overlap well no more than " +
                        format_number(100.0 * *recall, 2) + " % are loops" + front_end_text(cell) +
                        ".",
                    "few of the pairs that overlap are loops"});
}

// Of a recording, so that that of one estimator stands for all.
void add_disagreeing_measurements(const CellResults& cell, std::vector<Doubt>& doubts) {
  constexpr double kTooMuch = 3.0;
  for (const EstimatorResults& one : cell.estimators) {
    const auto optimum = finite_mean_of(one, "chi2_optimum");
    const auto registrations = finite_mean_of(one, "registrations");
    if (one.name == kDeadReckoning || !optimum || !registrations || *registrations <= 0.0) continue;
    const double per_degree = *optimum / (3.0 * *registrations);
    if (per_degree <= kTooMuch) return;
    doubts.push_back({"Measurements do not fit each other: F per degree of freedom is " +
                          format_number(per_degree, 3) +
                          " at its best, where 1 is expected; covariances of registrations or of "
                          "dead reckoning are too small, or loops are wrong.",
                      "measurements do not fit each other"});
    return;
  }
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
  add_few_loops(cell, doubts);
  add_disagreeing_measurements(cell, doubts);
  add_reference(cell, doubts);
  if (!verdict.cost.empty()) {
    add_jobs(cell, doubts);
    add_machines(cell, doubts);
  }
  return doubts;
}

}  // namespace fathom
