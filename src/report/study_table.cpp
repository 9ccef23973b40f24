#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>
#include <sstream>

#include "fathom/report/study_report.hpp"
#include "fathom/report/table.hpp"
#include "honesty_words.hpp"
#include "study_results.hpp"
#include "verdict.hpp"

namespace fathom {
namespace {

constexpr std::size_t kWidth = 160;
constexpr int kTableDigits = 3;

using Rows = std::vector<std::vector<std::string>>;

std::string interval_text(const std::optional<Interval>& interval) {
  return interval ? fmt::format(" [{}, {}]", format_number(interval->low, kTableDigits),
                                format_number(interval->high, kTableDigits))
                  : "";
}

// "0.112 [0.108, 0.117]"; with the number of values where that is not all that were done.
std::string value_text(const EstimatorResults& estimator, const std::string& metric) {
  const auto found = estimator.metrics.find(metric);
  if (found == estimator.metrics.end()) return "-";
  const MetricSummary& summary = found->second;
  std::string text =
      format_number(summary.moments.mean, kTableDigits) + interval_text(summary.interval);
  if (summary.moments.count < estimator.done) {
    text += " n=" + std::to_string(summary.moments.count);
  }
  return text;
}

std::size_t width_of(const std::string& text) {
  std::size_t width = 0;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) width = std::max(width, display_width(line));
  return width;
}

// `fixed` leading columns stand in every part; of the others as many as fit beside them.
std::string part_of(const std::vector<std::string>& header, const Rows& rows, std::size_t fixed,
                    std::size_t begin, std::size_t end) {
  const auto picked = [&](const std::vector<std::string>& cells) {
    const auto at = [&](std::size_t i) { return cells.begin() + static_cast<std::ptrdiff_t>(i); };
    std::vector<std::string> some(at(0), at(fixed));
    some.insert(some.end(), at(begin), at(end));
    return some;
  };
  Table table(picked(header));
  for (const auto& row : rows) table.add_row(picked(row));
  return table.text();
}

// All columns, in as many parts as the width asks for; in brief the first part alone.
std::string table_in_parts(const std::vector<std::string>& header, const Rows& rows,
                           std::size_t fixed, StudyTable extent) {
  std::string text;
  for (std::size_t begin = fixed; begin < header.size() || begin == fixed;) {
    std::size_t end = std::min(begin + 1, header.size());
    std::string part = part_of(header, rows, fixed, begin, end);
    while (end < header.size()) {
      const std::string wider = part_of(header, rows, fixed, begin, end + 1);
      if (width_of(wider) > kWidth) break;
      part = wider;
      ++end;
    }
    text += (text.empty() ? "" : "\n") + part;
    if (end == header.size() || extent == StudyTable::brief) break;
    begin = end;
  }
  return text;
}

std::string estimator_table(const CellResults& cell, const StudyDescription& study,
                            StudyTable extent, bool only_cost = false) {
  std::vector<std::string> metrics;
  for (const std::string& metric : study.metrics) {
    if (only_cost && !is_cost_metric(metric)) continue;
    if (std::any_of(cell.estimators.begin(), cell.estimators.end(),
                    [&](const auto& one) { return one.metrics.contains(metric); })) {
      metrics.push_back(metric);
    }
  }
  std::vector<std::string> header{"estimator", "outcome"};
  for (const std::string& metric : metrics) header.push_back(described(metric).label_with_unit());
  Rows rows;
  for (const EstimatorResults& one : cell.estimators) {
    const bool baseline = one.name == kDeadReckoning;
    rows.push_back({display_name(one.name), baseline ? "-" : outcome_text(one, study)});
    for (const std::string& metric : metrics) rows.back().push_back(value_text(one, metric));
  }
  return table_in_parts(header, rows, 2, extent);
}

// "30 trials", or of several surveys, whose means are tested, "10 surveys".
std::string pairs_text(const PairedDifference& difference) {
  return std::to_string(difference.count) + (difference.is_over_surveys ? " surveys" : " trials");
}

std::string paired_table(const CellResults& cell, const StudyDescription& study) {
  Rows rows;
  for (const PairedResult& one : cell.paired) {
    if (one.difference.count < 2) continue;
    rows.push_back(
        {one.estimator, described(one.metric).label_with_unit(), pairs_text(one.difference),
         format_number(one.difference.mean, kTableDigits) + interval_text(one.difference.interval),
         format_number(one.difference.signed_rank.p_value, kTableDigits),
         format_number(one.holm_p, kTableDigits)});
  }
  if (rows.empty()) return "";
  const std::string first = study.estimators.front().name;
  Table table({"minus " + first, "metric", "pairs", "mean difference", "p (Wilcoxon)", "p (Holm)"});
  for (auto& row : rows) table.add_row(std::move(row));
  return "\n" + table.text();
}

// A line for each estimator whose consistency means something.
std::string honesty_lines(const CellResults& cell) {
  std::string text;
  for (const EstimatorResults& one : cell.estimators) {
    if (!one.honesty) continue;
    text += display_name(one.name) + ":";
    for (const std::string& sentence : honesty_words(one)) text += " " + sentence;
    text += "\n";
  }
  return text.empty() ? "" : "\n" + text;
}

// "In 3 of 40 cells ekf is over- or underconfident": what is left of it in brief.
std::string words_in_brief(const StudyResults& results) {
  std::map<std::string, std::size_t> cells;
  for (const CellResults& cell : results.cells) {
    for (const EstimatorResults& one : cell.estimators) {
      if (one.honesty) ++cells[display_name(one.name)];
    }
  }
  std::string text;
  for (const auto& [name, count] : cells) {
    text += fmt::format("{}{} in {}", text.empty() ? "" : ", ", name, count);
  }
  if (text.empty()) return "";
  return fmt::format("Over- or underconfident, of {} cells: {}.\n", results.cells.size(), text);
}

// Costs on the kinds of processor that the blocks above say nothing of.
std::string costs_elsewhere(const ResultStore& store, const StudyResults& results) {
  std::string text;
  for (const StudyResults& other : results_of_other_machines(store, results, MetricsOf::study)) {
    const std::string& machine = other.cost_machine;
    text +=
        "Costs on " + (machine.empty() ? std::string("an unknown processor") : machine) + "\n\n";
    for (const CellResults& cell : other.cells) {
      text += cell_caption(cell) + "\n";
      text += estimator_table(cell, other.study, StudyTable::full, true) + "\n";
    }
  }
  return text;
}

}  // namespace

std::string study_table(const ResultStore& store, StudyTable extent) {
  const StudyResults results = study_results(store, MetricsOf::study);
  const StudyDescription& study = results.study;
  std::string text = study.title.empty() ? "" : study.title + "\n\n";
  std::set<std::string> limits;
  for (const CellResults& cell : results.cells) {
    text += cell_caption(cell) + "\n";
    text += estimator_table(cell, study, extent);
    if (extent == StudyTable::full) text += honesty_lines(cell) + paired_table(cell, study);
    text += "\n";
    limits.insert(limits_text(cell));
  }
  if (extent == StudyTable::brief) text += words_in_brief(results);
  if (extent == StudyTable::full) text += costs_elsewhere(store, results);
  if (const std::string intervals = intervals_text(results); !intervals.empty()) {
    text += intervals + "\n";
    if (extent == StudyTable::full) {
      text +=
          "p: signed-rank test over the pairs that both did; Holm: adjusted over all tests of the "
          "block.\n";
    }
  }
  for (const std::string& limit : limits) text += limit.empty() ? "" : limit + "\n";
  const std::string verdict = verdict_text(study_verdict(results));
  return verdict.empty() ? text : text + "\n" + verdict;
}

std::string study_remarks(const ResultStore& store) {
  const StudyResults results = study_results(store, MetricsOf::study);
  std::string text;
  for (const CellResults& cell : results.cells) {
    const std::string words = honesty_lines(cell);
    if (!words.empty()) text += cell_caption(cell) + words + "\n";
  }
  const std::string verdict = verdict_text(study_verdict(results));
  return verdict.empty() ? text : text + verdict + "\n";
}

}  // namespace fathom
