#include "fathom/workflow/result_table.hpp"

#include <cmath>
#include <fmt/format.h>
#include <map>

#include "fathom/report/table.hpp"

namespace fathom::workflow {
namespace {

// A metric as a column of the terminal's table.
struct Column {
  const char* heading;
  const char* metric;
  int digits;
  bool needs_ground_truth = false;  ///< left out where there is none
  bool needs_absolute = false;      ///< likewise
  bool needs_frames = false;        ///< likewise
};

constexpr Column kColumns[] = {
    {"loops", "loop_closures", 0},
    {"rejected", "rejected", 0},
    {"absolute", "absolute_used", 0, false, true},
    {"absolute rejected", "absolute_rejected", 0, false, true},
    {"chi2", "chi2", 6},
    {"mean error (m)", "mean_position_error_m", 4, true},
    {"of all frames (m)", "frame_mean_position_error_m", 4, true, false, true},
    {"ATE RMSE (m)", "ate_rmse_m", 4, true},
    {"heading RMSE (rad)", "heading_rmse_rad", 3, true},
    {"ANEES", "anees", 3, true},
    {"update median (ms)", "update_ms.median", 3},
    {"p95", "update_ms.p95", 3},
    {"max", "update_ms.max", 3},
    {"total (ms)", "total_ms", 4},
    {"memory (KiB)", "memory_bytes", 0}};

// Of all frames only where all have ground truth.
std::string heading_of(const Column& column, const Recording& recording) {
  const std::size_t known = recording.frame_ground_truth.size();
  if (!column.needs_frames || known == recording.frames.size()) return column.heading;
  return fmt::format("of {} of {} frames (m)", known, recording.frames.size());
}

std::string cell_of(const Column& column, const std::map<std::string, double>& metrics) {
  const auto found = metrics.find(column.metric);
  if (found == metrics.end()) return "-";
  if (column.digits > 0) return format_number(found->second, column.digits);
  const bool is_memory = std::string(column.metric) == "memory_bytes";
  return std::to_string(std::llround(found->second / (is_memory ? 1024.0 : 1.0)));
}

}  // namespace

std::string result_table(const Recording& recording, const std::vector<Result>& results) {
  std::vector<Column> columns;
  for (const Column& column : kColumns) {
    if (column.needs_ground_truth && !recording.ground_truth) continue;
    if (column.needs_frames && recording.frames.empty()) continue;
    if (column.needs_absolute && recording.log.absolute_count() == 0) continue;
    columns.push_back(column);
  }
  std::vector<std::string> header{"", "outcome"};
  for (const Column& column : columns) header.push_back(heading_of(column, recording));
  Table table(header);
  const auto add_row = [&](const std::string& name, const std::string& outcome,
                           const std::map<std::string, double>& metrics) {
    std::vector<std::string> row{name, outcome};
    for (const Column& column : columns) row.push_back(cell_of(column, metrics));
    table.add_row(row);
  };
  const MetricOptions options = results.empty() ? MetricOptions() : results.front().options;
  add_row("dead reckoning", "-", dead_reckoning_metrics(recording, options));
  for (const Result& result : results) {
    add_row(result.estimator.name, name_of(result.run.outcome), result.metrics);
  }
  std::string text = table.text();
  for (const Result& result : results) {
    if (!result.run.fault.empty()) text += result.estimator.name + ": " + result.run.fault + "\n";
  }
  return text;
}

}  // namespace fathom::workflow
