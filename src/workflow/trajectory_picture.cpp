#include "fathom/workflow/trajectory_picture.hpp"

#include <algorithm>

#include "fathom/core/files.hpp"

namespace fathom::workflow {
namespace {

// Estimators that choose their own keyframes may have another log.
void add_marks(PlotSeries& series, const MeasurementLog& log, const Run& run) {
  if (log.size() != run.trajectory.size()) return;
  if (log.absolute_count() != run.absolute_weights.size()) return;
  std::size_t next = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      series.absolute.push_back(absolute_mark(z, is_kept(run.absolute_weights[next++])));
    }
  }
}

PlotSeries series_of(const MeasurementLog& log, const Result& result, std::size_t place,
                     bool with_details) {
  PlotSeries series;
  series.name = result.estimator.name;
  series.style = estimator_style(place);
  series.may_leave = !result.is_done();
  series.poses = result.run.trajectory;
  add_marks(series, log, result.run);
  if (!with_details) return series;
  if (result.run.covariances) series.covariances = *result.run.covariances;
  for (const LoopDecision& loop : result.run.loops) {
    if (loop.fate == LoopFate::used) series.loops.emplace_back(loop.from, loop.to);
  }
  return series;
}

// Ground truth where the estimates are. A fixed start says where that is. Of an uncertain one the
// absolute measurements do, and the alignment of the errors says how they lie in the truth's frame.
std::vector<Pose> truth_in_world(const Recording& recording, const std::vector<Result>& results) {
  const std::vector<Pose>& truth = *recording.ground_truth;
  const auto done = std::ranges::find_if(results, [&truth](const Result& result) {
    return result.is_done() && result.run.trajectory.size() == truth.size();
  });
  if (recording.log.start().is_fixed() || done == results.end()) {
    return align(truth, recording.log.odometry(), Alignment::origin).poses;
  }
  const Pose motion =
      inverse(alignment_motion(done->run.trajectory, truth, done->options.alignment));
  std::vector<Pose> moved;
  moved.reserve(truth.size());
  for (const Pose& pose : truth) moved.push_back(compose(motion, pose));
  return moved;
}

}  // namespace

TrajectoryPlot trajectory_plot(const std::string& title, const Recording& recording,
                               const std::vector<Result>& results, std::size_t first_place,
                               bool with_details) {
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
        series_of(recording.log, results[place], first_place + place, with_details && place == 0));
  }
  if (results.size() > 1) keep_one_set_of_marks(plot.series);
  return plot;
}

void write_trajectory_picture(const std::filesystem::path& path, const std::string& title,
                              const Recording& recording, const std::vector<Result>& results,
                              std::size_t first_place, bool with_details) {
  write_file(path,
             trajectory_png(trajectory_plot(title, recording, results, first_place, with_details)));
}

}  // namespace fathom::workflow
