#include <algorithm>
#include <cctype>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <optional>
#include <set>

#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"
#include "scaled_unit.hpp"
#include "study_figures.hpp"
#include "verdict.hpp"
#include "verdict_answer.hpp"
#include "verdict_failures.hpp"

namespace fathom {
namespace {

void add_cost(const StudyResults& results, StudyVerdict& verdict) {
  std::map<std::string, std::size_t> cheapest;
  double least = INFINITY;
  double most = 0.0;
  std::size_t unsure = 0;
  for (const CellVerdict& cell : verdict.cells) {
    if (!cell.by_cost) continue;
    ++cheapest[cell.by_cost->best().name];
    unsure += cell.as_cheap.empty() ? 0 : 1;
    const double mean = cell.by_cost->best().summary.moments.mean;
    least = std::min(least, mean);
    most = std::max(most, mean);
  }
  if (cheapest.empty()) return;
  std::vector<std::string> parts;
  parts.reserve(cheapest.size());
  for (const auto& [name, count] : cheapest) {
    parts.push_back(name + " in " + of_cells(count, results.cells.size()));
  }
  const Metric metric = described(*verdict.cost);
  const ScaledUnit unit = reading_unit(metric.unit, most);
  verdict.cost_words = {fmt::format(
      "Cheapest of those within 5 % of the best: {}; {} {} to {}.", listed(parts), metric.label,
      quantity(least, std::nullopt, unit), quantity(most, std::nullopt, unit))};
  if (unsure == 0) return;
  verdict.cost_words.push_back(fmt::format("In {} others as good are not shown to be dearer.",
                                           of_cells(unsure, results.cells.size())));
}

// In how many cells a doubt is raised, and of whom.
struct DoubtCount {
  std::size_t cells = 0;
  std::map<std::string, std::size_t> estimators;
};

// ": ekf in 4 and smoother in 2", or ": ekf and smoother" where both are in all of them.
std::string named_in(const DoubtCount& count) {
  const bool is_in_all = std::ranges::all_of(
      count.estimators, [&](const auto& one) { return one.second == count.cells; });
  std::vector<std::string> names;
  for (const auto& [name, cells] : count.estimators) {
    names.push_back(is_in_all ? name : fmt::format("{} in {}", name, cells));
  }
  return names.empty() ? "" : ": " + listed(names);
}

void add_doubts(StudyVerdict& verdict) {
  std::vector<std::string> order;
  std::map<std::string, DoubtCount> counts;
  for (const CellVerdict& cell : verdict.cells) {
    std::map<std::string, std::set<std::string>> own;
    for (const Doubt& doubt : cell.doubts) {
      const std::string text = words_in_general(doubt);
      if (!counts.contains(text)) order.push_back(text);
      counts[text];
      const std::vector<std::string> names = estimators_of(doubt);
      own[text].insert(names.begin(), names.end());
    }
    for (const auto& [text, names] : own) {
      ++counts[text].cells;
      for (const std::string& name : names) ++counts[text].estimators[name];
    }
  }
  for (std::string text : order) {
    const DoubtCount& count = counts.at(text);
    if (text.ends_with('.') && count.cells == verdict.cells.size()) {
      verdict.doubts.push_back(text);
      continue;
    }
    if (text.ends_with('.')) text.pop_back();
    const char* between = std::isupper(static_cast<unsigned char>(text.front())) ? ": " : " ";
    verdict.doubts.push_back("In " + of_cells(count.cells, verdict.cells.size()) + between + text +
                             named_in(count) + ".");
  }
}

std::string rule_of(const StudyVerdict& verdict, double margin) {
  const bool is_given = std::ranges::any_of(verdict.cells, [](const CellVerdict& cell) {
    return cell.ranking && cell.ranking->estimators.size() > 1 && cell.ranking->gives_verdict();
  });
  if (!is_given) return "";
  return fmt::format(
      "Worse: p of the signed-rank test, adjusted over all pairs of a cell, is below 0.05, and the "
      "difference is more than {} % of the best (report.margin). Equivalent: it is shown to lie "
      "within that. The intervals of a cell hold together with 95 %.",
      format_number(100.0 * margin, 3));
}

}  // namespace

StudyVerdict study_verdict(const StudyResults& results) {
  StudyVerdict verdict;
  const RankingMetric by = ranking_metric(results);
  verdict.metric = by.name;
  verdict.cost = first_metric(results, true);
  for (const CellResults& cell : results.cells) {
    verdict.cells.push_back(cell_verdict(cell, results.study, by, verdict.cost));
  }
  verdict.rule = rule_of(verdict, results.study.margin);
  if (verdict.cells.size() == 1) {
    const CellVerdict& only = verdict.cells.front();
    verdict.answer = only.answer;
    verdict.cost_words = only.cost;
    verdict.failed = only.failed;
    for (const Doubt& doubt : only.doubts) verdict.doubts.push_back(words_of(doubt));
    add_empty_cells(results, verdict.failed);
    return verdict;
  }
  verdict.answer = before_ranking(by);
  add_answer(results, verdict);
  add_cost(results, verdict);
  verdict.failed = failures_of(results);
  add_doubts(verdict);
  return verdict;
}

std::string verdict_text(const StudyVerdict& verdict) {
  std::string text;
  const auto add = [&text](const std::string& title, const std::vector<std::string>& sentences) {
    for (const std::string& sentence : sentences) text += title + sentence + "\n";
  };
  add("", verdict.answer);
  add("", verdict.cost_words);
  add("", verdict.failed);
  add("Doubt: ", verdict.doubts);
  if (!verdict.rule.empty()) text += verdict.rule + "\n";
  return text.empty() ? "" : "Verdict\n" + text;
}

}  // namespace fathom
