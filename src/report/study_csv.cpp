#include "study_csv.hpp"

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// What a spreadsheet takes for the beginning of a formula, and runs.
constexpr std::string_view kFormula = "=+-@\t\r";

std::string line_of(const std::vector<std::string>& fields) {
  std::string line;
  for (std::size_t i = 0; i < fields.size(); ++i) line += (i > 0 ? "," : "") + csv_field(fields[i]);
  return line + "\n";
}

std::string number(const std::optional<double>& value) {
  return value ? exact(*value) : "";
}

// What opens every line: the cell, its values on the axes, its association and alignment.
std::vector<std::string> cell_header(const StudyDescription& study) {
  std::vector<std::string> header{"cell"};
  for (const StudyAxis& axis : study.axes) header.push_back(axis.name);
  header.insert(header.end(), {"association", "alignment"});
  return header;
}

std::vector<std::string> cell_fields(const CellResults& cell, const StudyDescription& study) {
  std::vector<std::string> fields{std::to_string(cell.cell)};
  const std::vector<std::size_t> places = study.places_of(cell.cell);
  for (std::size_t i = 0; i < places.size(); ++i) {
    fields.push_back(study.axes[i].labels[places[i]]);
  }
  fields.insert(fields.end(), {cell.association, cell.alignment});
  return fields;
}

void append(std::vector<std::string>& fields, std::vector<std::string> more) {
  for (std::string& field : more) fields.push_back(std::move(field));
}

std::string run_line(const RunRecord& run, std::vector<std::string> fields,
                     const std::vector<std::string>& metrics) {
  append(fields, {std::to_string(run.key.survey), std::to_string(run.key.trial), run.key.estimator,
                  run.outcome, std::to_string(run.jobs), run.machine});
  for (const std::string& metric : metrics) {
    const auto found = run.metrics.find(metric);
    fields.push_back(found == run.metrics.end() ? "" : exact(found->second));
  }
  return line_of(fields);
}

std::string summary_line(const EstimatorResults& one, const std::string& metric,
                         std::vector<std::string> fields) {
  const std::string machine = is_cost_metric(metric) ? one.cost_machine : "";
  const auto found = one.metrics.find(metric);
  if (found == one.metrics.end()) {
    append(fields, {one.name, metric, "0", "0", std::to_string(one.failures()), "", "", "", "", "",
                    machine});
    return line_of(fields);
  }
  const Moments& moments = found->second.moments;
  append(fields, {one.name, metric, std::to_string(found->second.surveys),
                  std::to_string(moments.count), std::to_string(one.failures()),
                  exact(moments.mean), number(moments.standard_deviation), exact(moments.median)});
  const std::optional<Interval>& interval = found->second.interval;
  append(fields,
         {interval ? exact(interval->low) : "", interval ? exact(interval->high) : "", machine});
  return line_of(fields);
}

}  // namespace

std::string csv_field(std::string_view text) {
  const bool is_formula =
      !text.empty() && kFormula.find(text.front()) != std::string_view::npos && !parse_real(text);
  if (!is_formula && text.find_first_of(",\"\r\n") == std::string_view::npos) {
    return std::string(text);
  }
  std::string field = is_formula ? "\"'" : "\"";
  for (const char letter : text) field += letter == '"' ? "\"\"" : std::string(1, letter);
  return field + "\"";
}

std::string runs_csv(const StudyResults& results) {
  std::vector<std::string> header = cell_header(results.study);
  append(header, {"survey", "trial", "estimator", "outcome", "jobs", "machine"});
  append(header, results.metrics);
  std::string text = line_of(header);
  for (const CellResults& cell : results.cells) {
    const std::vector<std::string> fields = cell_fields(cell, results.study);
    for (const EstimatorResults& one : cell.estimators) {
      for (const RunRecord& run : one.runs) text += run_line(run, fields, results.metrics);
    }
  }
  return text;
}

std::string summary_csv(const StudyResults& results, const std::vector<StudyResults>& others) {
  std::vector<std::string> header = cell_header(results.study);
  append(header, {"estimator", "metric", "surveys", "n", "failures", "mean", "sd", "median",
                  "low_95", "high_95", "machine"});
  std::string text = line_of(header);
  const auto add = [&text](const StudyResults& of, bool only_cost) {
    for (const CellResults& cell : of.cells) {
      for (const EstimatorResults& one : cell.estimators) {
        for (const std::string& metric : of.metrics) {
          if (only_cost && !is_cost_metric(metric)) continue;
          text += summary_line(one, metric, cell_fields(cell, of.study));
        }
      }
    }
  };
  add(results, false);
  for (const StudyResults& other : others) add(other, true);
  return text;
}

}  // namespace fathom
