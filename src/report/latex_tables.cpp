#include "latex_tables.hpp"

#include <algorithm>
#include <set>

#include "fathom/core/text.hpp"
#include "fathom/measurements/decision.hpp"
#include "latex_text.hpp"

namespace fathom {
namespace {

constexpr std::size_t kMostTables = 6;
constexpr int kLatexDigits = 3;

std::string latex_value(const EstimatorResults& one, const std::string& metric) {
  const auto found = one.metrics.find(metric);
  if (found == one.metrics.end()) return "--";
  std::string text = latex_number(found->second.moments.mean, kLatexDigits);
  if (const auto& interval = found->second.interval) {
    text += " {\\scriptsize [" + latex_number(interval->low, kLatexDigits) + ", " +
            latex_number(interval->high, kLatexDigits) + "]}";
  }
  if (found->second.moments.count < one.done) {
    text += " {\\scriptsize $n = " + std::to_string(found->second.moments.count) + "$}";
  }
  return text;
}

std::string row_of(const std::vector<std::string>& cells) {
  std::string row = "    ";
  for (std::size_t i = 0; i < cells.size(); ++i) row += (i > 0 ? " & " : "") + cells[i];
  return row + " \\\\\n";
}

std::string table_of(const std::string& caption, const std::string& label,
                     const std::vector<std::string>& header,
                     const std::vector<std::vector<std::string>>& rows) {
  std::string text = "\\begin{table}\n  \\centering\n  \\caption{" + caption + "}\n  \\label{" +
                     label + "}\n  \\begin{tabular}{l" + std::string(header.size() - 1, 'r') +
                     "}\n    \\toprule\n" + row_of(header) + "    \\midrule\n";
  for (const auto& row : rows) text += row_of(row);
  return text + "    \\bottomrule\n  \\end{tabular}\n\\end{table}\n";
}

std::string run_counts(const EstimatorResults& one) {
  if (one.name == kDeadReckoning) return "--";
  const std::size_t without = runs_without_loops(one);
  const auto limited = one.outcomes.find(name_of(Outcome::iteration_limit));
  return std::to_string(one.done) + "/" + std::to_string(one.runs.size()) +
         (limited == one.outcomes.end()
              ? ""
              : ", " + std::to_string(limited->second) + " at iteration limit") +
         (without > 0 ? ", " + std::to_string(without) + " without loops" : "");
}

std::string title_of(const StudyDescription& study) {
  return study.title.empty() ? "" : latex_text(study.title) + ". ";
}

// How means are made, and what their intervals do not speak of.
std::string meaning_of(const StudyResults& results) {
  std::string text = latex_text(intervals_text(results));
  std::set<std::string> limits;
  for (const CellResults& cell : results.cells) limits.insert(limits_text(cell));
  for (const std::string& limit : limits) text += limit.empty() ? "" : " " + latex_text(limit);
  return text.empty() ? "" : " " + text;
}

std::string cell_table(const CellResults& cell, const StudyResults& results) {
  std::vector<std::string> metrics;
  for (const std::string& metric : results.study.metrics) {
    if (std::any_of(cell.estimators.begin(), cell.estimators.end(),
                    [&](const auto& one) { return one.metrics.contains(metric); })) {
      metrics.push_back(metric);
    }
  }
  std::vector<std::string> header{"estimator", "done"};
  for (const auto& metric : metrics)
    header.push_back(latex_text(described(metric).label_with_unit()));
  std::vector<std::vector<std::string>> rows;
  for (const EstimatorResults& one : cell.estimators) {
    rows.push_back({latex_text(display_name(one.name)), run_counts(one)});
    for (const std::string& metric : metrics) rows.back().push_back(latex_value(one, metric));
  }
  const std::string caption = title_of(results.study) + latex_text(cell_caption(cell)) + "." +
                              (cell.trials > 1 ? meaning_of(results) : "");
  return table_of(caption, "tab:fathom-cell-" + std::to_string(cell.cell), header, rows);
}

// "alignment origin/se2": all that occur among the cells; empty where none is known.
std::string joint_text(const std::string& what, const StudyResults& results,
                       std::string CellResults::*member) {
  std::vector<std::string> values;
  for (const CellResults& cell : results.cells) {
    if (!(cell.*member).empty() &&
        std::find(values.begin(), values.end(), cell.*member) == values.end()) {
      values.push_back(cell.*member);
    }
  }
  return values.empty() ? "" : what + " " + joined(values, "/") + ", ";
}

// Of the cells, which may differ.
std::string joint_caption(const StudyResults& results) {
  std::vector<const CellResults*> cells;
  for (const CellResults& cell : results.cells) cells.push_back(&cell);
  return latex_text(joint_text("alignment", results, &CellResults::alignment) +
                    joint_text("association", results, &CellResults::association) +
                    joint_text("loops selected by", results, &CellResults::selected_by) +
                    repeats_of(cells));
}

std::vector<std::string> names_of(const StudyResults& results) {
  std::vector<std::string> names{kDeadReckoning};
  for (const StudyEstimator& one : results.study.estimators) names.push_back(one.name);
  return names;
}

std::string metric_table(const std::string& metric, std::size_t number,
                         const StudyResults& results) {
  const std::vector<std::string> names = names_of(results);
  std::vector<std::string> header{"cell"};
  for (const std::string& name : names) header.push_back(latex_text(display_name(name)));
  std::vector<std::vector<std::string>> rows;
  bool is_counted = false;
  for (const CellResults& cell : results.cells) {
    rows.push_back({latex_text(cell.label)});
    for (const std::string& name : names) {
      const auto one = std::find_if(cell.estimators.begin(), cell.estimators.end(),
                                    [&](const auto& known) { return known.name == name; });
      std::string text = one == cell.estimators.end() ? "--" : latex_value(*one, metric);
      if (one != cell.estimators.end() && (one->failures() > 0 || runs_without_loops(*one) > 0)) {
        text += " (" + run_counts(*one) + ")";
        is_counted = true;
      }
      rows.back().push_back(text);
    }
  }
  const std::string caption =
      title_of(results.study) + latex_text(described(metric).label_with_unit()) + ": " +
      joint_caption(results) + "." + meaning_of(results) +
      (is_counted ? " In parentheses how many of the trials were done, where not all with loops."
                  : "");
  return table_of(caption, "tab:fathom-metric-" + std::to_string(number), header, rows);
}

}  // namespace

std::string latex_tables(const StudyResults& results) {
  std::string text = "% Needs \\usepackage{booktabs}.\n";
  if (results.cells.size() <= kMostTables) {
    for (const CellResults& cell : results.cells) text += "\n" + cell_table(cell, results);
    return text;
  }
  std::size_t number = 0;
  for (const std::string& metric : results.study.metrics) {
    text += "\n" + metric_table(metric, number++, results);
  }
  return text;
}

}  // namespace fathom
