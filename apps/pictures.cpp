#include "apps/pictures.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/files.hpp"
#include "fathom/report/table.hpp"
#include "fathom/report/trajectory_plot.hpp"

namespace fathom {
namespace {

// Estimators that choose their own keyframes may have another log.
void add_marks(PlotSeries& series, const MeasurementLog& log, const Replay& replay) {
  if (log.size() != replay.trajectory.size()) return;
  if (log.absolute_count() != replay.absolute_weights.size()) return;
  std::size_t next = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      series.absolute.push_back(absolute_mark(z, replay.absolute_weights[next++] > 0.5));
    }
  }
}

PlotSeries series_of(const MeasurementLog& log, const Result& result, std::size_t place,
                     bool with_details) {
  PlotSeries series;
  series.name = result.estimator.name;
  series.style = estimator_style(place);
  const Outcome outcome = result.replay.outcome;
  series.may_leave = outcome != Outcome::converged && outcome != Outcome::iteration_limit;
  series.poses = result.replay.trajectory;
  add_marks(series, log, result.replay);
  if (!with_details) return series;
  if (result.replay.covariances) series.covariances = *result.replay.covariances;
  for (const LoopDecision& loop : result.replay.loops) {
    if (loop.fate == LoopFate::used) series.loops.emplace_back(loop.from, loop.to);
  }
  return series;
}

// Ground truth where the estimates are. A fixed start says where that is. Of an uncertain one the
// absolute measurements do, and the alignment of the errors says how they lie in the truth's frame.
std::vector<Pose> truth_in_world(const Recording& recording, const std::vector<Result>& results) {
  const std::vector<Pose>& truth = *recording.ground_truth;
  const auto done = std::ranges::find_if(results, [&truth](const Result& result) {
    return result.is_done() && result.replay.trajectory.size() == truth.size();
  });
  if (recording.log.start().is_fixed() || done == results.end()) {
    return align(truth, recording.log.odometry(), Alignment::origin).poses;
  }
  const Pose motion =
      inverse(alignment_motion(done->replay.trajectory, truth, done->options.alignment));
  std::vector<Pose> moved;
  for (const Pose& pose : truth) moved.push_back(compose(motion, pose));
  return moved;
}

// A metric as a column of the terminal's table.
struct Column {
  const char* heading;
  const char* metric;
  int digits;
  bool needs_ground_truth = false;  ///< left out where there is none
  bool needs_absolute = false;      ///< likewise
};

constexpr Column kColumns[] = {{"loops", "loop_closures", 0},
                               {"rejected", "rejected", 0},
                               {"absolute", "absolute_used", 0, false, true},
                               {"absolute rejected", "absolute_rejected", 0, false, true},
                               {"chi2", "chi2", 6},
                               {"mean error (m)", "mean_position_error_m", 4, true},
                               {"ATE RMSE (m)", "ate_rmse_m", 4, true},
                               {"heading RMSE (rad)", "heading_rmse_rad", 3, true},
                               {"ANEES", "anees", 3, true},
                               {"update median (ms)", "update_ms.median", 3},
                               {"p95", "update_ms.p95", 3},
                               {"max", "update_ms.max", 3},
                               {"total (ms)", "total_ms", 4},
                               {"memory (KiB)", "memory_bytes", 0}};

std::string cell_of(const Column& column, const std::map<std::string, double>& metrics) {
  const auto found = metrics.find(column.metric);
  if (found == metrics.end()) return "-";
  if (column.digits > 0) return format_number(found->second, column.digits);
  const bool is_memory = std::string(column.metric) == "memory_bytes";
  return std::to_string(std::llround(found->second / (is_memory ? 1024.0 : 1.0)));
}

}  // namespace

void write_trajectory_picture(const std::filesystem::path& path, const std::string& title,
                              const Recording& recording, const std::vector<Result>& results,
                              std::size_t first_place) {
  TrajectoryPlot plot;
  plot.title = title;
  const std::vector<Pose> odometry = recording.log.odometry();
  if (recording.ground_truth) {
    plot.series.push_back(
        {"ground truth", ground_truth_style(), truth_in_world(recording, results), {}, {}, false});
  }
  plot.series.push_back({"dead reckoning", dead_reckoning_style(), odometry, {}, {}, true});
  for (std::size_t place = 0; place < results.size(); ++place) {
    plot.series.push_back(
        series_of(recording.log, results[place], first_place + place, results.size() == 1));
  }
  if (results.size() > 1) keep_one_set_of_marks(plot.series);
  write_file(path, trajectory_png(plot));
}

std::string result_table(const Recording& recording, const std::vector<Result>& results) {
  std::vector<Column> columns;
  for (const Column& column : kColumns) {
    if (column.needs_ground_truth && !recording.ground_truth) continue;
    if (column.needs_absolute && recording.log.absolute_count() == 0) continue;
    columns.push_back(column);
  }
  std::vector<std::string> header{"", "outcome"};
  for (const Column& column : columns) header.emplace_back(column.heading);
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
    add_row(result.estimator.name, name_of(result.replay.outcome), result.metrics);
  }
  return table.text();
}

}  // namespace fathom
