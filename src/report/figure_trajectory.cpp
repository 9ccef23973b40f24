#include <algorithm>
#include <cmath>
#include <memory>

#include "fathom/results/run_index.hpp"
#include "fathom/results/run_series.hpp"
#include "keyframe_series.hpp"
#include "stored_absolute.hpp"
#include "study_figures.hpp"
#include "trajectory_map.hpp"

namespace fathom {
namespace {

std::vector<Pose> path_of(const ResultStore& store, const RunKey& key, const RunSeries<double>& x_m,
                          const RunSeries<double>& y_m) {
  const auto x = series_of(store, key, x_m);
  const auto y = series_of(store, key, y_m);
  std::vector<Pose> poses;
  if (!x || !y || x->size() != y->size()) return poses;
  for (std::size_t k = 0; k < x->size(); ++k) poses.push_back({(*x)[k], (*y)[k], 0.0});
  return poses;
}

// So many loops at most, evenly thinned: more would be one grey area, and a large file.
constexpr std::size_t kMostLoops = 5000;

void add_loops(PlotSeries& series, const ResultStore& store, const RunKey& key) {
  const auto from = series_of(store, key, series::loop_from);
  const auto to = series_of(store, key, series::loop_to);
  const auto fate = series_of(store, key, series::loop_fate);
  if (!from || !to || !fate || from->size() != to->size() || from->size() != fate->size()) return;
  for (std::size_t i = 0; i < from->size(); ++i) {
    const bool is_there = std::max((*from)[i], (*to)[i]) < series.poses.size();
    if ((*fate)[i] == LoopFate::used && is_there) series.loops.emplace_back((*from)[i], (*to)[i]);
  }
  series.loops = picked(series.loops, thinned(series.loops.size(), kMostLoops));
}

bool is_done_at(const EstimatorResults& one, const TrialKey& trial) {
  return std::any_of(one.runs.begin(), one.runs.end(), [&trial](const RunRecord& run) {
    return run.key.trial_key() == trial && !is_failed(run);
  });
}

TrajectoryPlot plot_of(const ResultStore& store, const CellResults& cell, const TrialKey& trial,
                       const std::map<std::string, LineStyle>& styles) {
  TrajectoryPlot plot;
  std::vector<Pose> truth = path_of(store, {cell.cell, trial.survey, trial.trial, kDeadReckoning},
                                    series::truth_x_m, series::truth_y_m);
  bool has_loops = false;
  for (const EstimatorResults& one : cell.estimators) {
    const RunKey key{cell.cell, trial.survey, trial.trial, one.name};
    PlotSeries series{display_name(one.name),
                      styles.at(one.name),
                      path_of(store, key, series::x_m, series::y_m),
                      {},
                      {},
                      false};
    if (series.poses.empty()) continue;
    const bool baseline = one.name == kDeadReckoning;
    if (!baseline && !has_loops) {
      add_loops(series, store, key);
      has_loops = !series.loops.empty();
    }
    series.absolute = marks_of(stored_absolute(store, key, series.poses.size()));
    series.may_leave = baseline || !is_done_at(one, trial);
    plot.series.push_back(std::move(series));
  }
  keep_one_set_of_marks(plot.series);
  if (!plot.series.empty() && !truth.empty()) {
    plot.series.insert(plot.series.begin(),
                       {"ground truth", ground_truth_style(), std::move(truth), {}, {}, false});
  }
  return plot;
}

}  // namespace

void add_trajectory_figures(const FigureInput& input, std::vector<StudyFigure>& figures) {
  const StudyResults& results = input.results;
  const auto styles = line_styles(results.study);
  for (const CellResults& cell : results.cells) {
    const TrialKey trial = first_trial(cell);
    const auto plot =
        std::make_shared<const TrajectoryPlot>(plot_of(input.store, cell, trial, styles));
    if (plot->series.empty()) continue;
    const std::string conditions = example_text(cell, trial) + " of " + cell_caption(cell);
    const FigureLayout layout({220.0}, TrajectoryMap(*plot).legend(), conditions);
    figures.push_back({figure_title("trajectories", cell.label, results.cells.size() == 1),
                       layout.height(), [plot, layout](Canvas& canvas) {
                         TrajectoryMap(*plot).draw(canvas, layout.chart(0));
                         layout.draw_footer(canvas);
                       }});
  }
}

}  // namespace fathom
