#include "apps/pictures.hpp"

#include "fathom/core/files.hpp"
#include "fathom/report/table.hpp"
#include "fathom/report/trajectory_plot.hpp"

namespace fathom {
namespace {

PlotSeries series_of(const Result& result, std::size_t place, bool with_details) {
  PlotSeries series;
  series.name = result.estimator.name;
  series.style = estimator_style(place);
  const Outcome outcome = result.replay.outcome;
  series.may_leave = outcome != Outcome::converged && outcome != Outcome::iteration_limit;
  series.poses = result.replay.trajectory;
  if (!with_details) return series;
  if (result.replay.covariances) series.covariances = *result.replay.covariances;
  for (const LoopDecision& loop : result.replay.loops) {
    if (loop.fate == LoopFate::used) series.loops.emplace_back(loop.from, loop.to);
  }
  return series;
}

template <class Value>
std::optional<double> number(const std::optional<Value>& from, double Value::*member) {
  return from ? std::optional<double>((*from).*member) : std::nullopt;
}

std::string kilobytes(const std::optional<std::int64_t>& bytes) {
  if (!bytes) return "-";
  return std::to_string((*bytes + 512) / 1024);
}

std::vector<std::string> accuracy_cells(const std::optional<Accuracy>& accuracy) {
  return {format_number(number(accuracy, &Accuracy::mean_position_error_m), 4),
          format_number(number(accuracy, &Accuracy::ate_rmse_m), 4),
          format_number(number(accuracy, &Accuracy::heading_rmse_rad), 3)};
}

}  // namespace

void write_trajectory_picture(const std::filesystem::path& path, const std::string& title,
                              const Recording& recording, const std::vector<Result>& results,
                              std::size_t first_place) {
  TrajectoryPlot plot;
  plot.title = title;
  const std::vector<Pose> odometry = recording.log.odometry();
  if (recording.ground_truth) {
    plot.series.push_back({"ground truth",
                           ground_truth_style(),
                           align(*recording.ground_truth, odometry, Alignment::origin).poses,
                           {},
                           {},
                           false});
  }
  plot.series.push_back({"dead reckoning", dead_reckoning_style(), odometry, {}, {}, true});
  for (std::size_t place = 0; place < results.size(); ++place) {
    plot.series.push_back(series_of(results[place], first_place + place, results.size() == 1));
  }
  write_file(path, trajectory_png(plot));
}

std::string result_table(const Recording& recording, const std::vector<Result>& results,
                         Alignment alignment) {
  const bool judged = recording.ground_truth.has_value();
  std::vector<std::string> header{"", "outcome", "loops", "rejected", "chi2"};
  if (judged) {
    header.insert(header.end(), {"mean error (m)", "ATE RMSE (m)", "heading RMSE (rad)", "ANEES"});
  }
  header.insert(header.end(), {"update median (ms)", "p95", "max", "total (ms)", "memory (KiB)"});
  Table table(header);

  std::vector<std::string> baseline{
      "dead reckoning", "-", "-", "-",
      format_number(chi2(recording.log, recording.log.odometry()), 6)};
  if (judged) {
    for (std::string& cell : accuracy_cells(dead_reckoning_accuracy(recording, alignment))) {
      baseline.push_back(std::move(cell));
    }
  }
  baseline.resize(header.size(), "-");
  table.add_row(baseline);

  for (const Result& result : results) {
    std::vector<std::string> row{result.estimator.name, name_of(result.replay.outcome),
                                 std::to_string(result.loop_closures),
                                 std::to_string(result.rejected), format_number(result.chi2, 6)};
    if (judged) {
      for (std::string& cell : accuracy_cells(result.accuracy)) row.push_back(std::move(cell));
      row.push_back(format_number(number(result.consistency, &Consistency::anees), 3));
    }
    row.push_back(format_number(number(result.update_ms, &Summary::median), 3));
    row.push_back(format_number(number(result.update_ms, &Summary::p95), 3));
    row.push_back(format_number(number(result.update_ms, &Summary::max), 3));
    row.push_back(format_number(result.replay.total_ms, 4));
    row.push_back(kilobytes(result.replay.memory_bytes));
    table.add_row(row);
  }
  return table.text();
}

}  // namespace fathom
