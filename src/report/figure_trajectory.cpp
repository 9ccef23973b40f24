#include <algorithm>
#include <cmath>

#include "study_figures.hpp"

namespace fathom {
namespace {

using Points = std::vector<Eigen::Vector2d>;

struct TrajectoryChart {
  std::size_t trial = 0;
  std::vector<std::pair<std::string, Points>> paths;  ///< (x, y) in metres
  Points truth;
  std::vector<Points> loops;  ///< of the first estimator, those used
  std::string loops_of;
};

Points path_of(const ResultStore& store, const RunKey& key, const char* x_name,
               const char* y_name) {
  const auto x = store.series(key, x_name);
  const auto y = store.series(key, y_name);
  Points points;
  if (!x || !y || x->size() != y->size()) return points;
  for (std::size_t k = 0; k < x->size(); ++k) {
    if (std::isfinite((*x)[k]) && std::isfinite((*y)[k])) points.emplace_back((*x)[k], (*y)[k]);
  }
  return points;
}

void add_loops(TrajectoryChart& chart, const ResultStore& store, const RunKey& key,
               const Points& path) {
  const auto from = store.series(key, "loop_from");
  const auto to = store.series(key, "loop_to");
  const auto fate = store.series(key, "loop_fate");
  if (!from || !to || !fate || from->size() != to->size() || from->size() != fate->size()) return;
  chart.loops_of = key.estimator;
  const auto is_there = [&path](double k) {
    return k >= 0.0 && k < static_cast<double>(path.size());
  };
  for (std::size_t i = 0; i < from->size(); ++i) {
    if ((*fate)[i] != 0.0 || !is_there((*from)[i]) || !is_there((*to)[i])) continue;
    chart.loops.push_back(
        {path[static_cast<std::size_t>((*from)[i])], path[static_cast<std::size_t>((*to)[i])]});
  }
}

TrajectoryChart chart_of(const ResultStore& store, const CellResults& cell) {
  TrajectoryChart chart;
  chart.trial = cell.estimators.front().runs.front().key.trial;
  for (const EstimatorResults& one : cell.estimators) {
    chart.trial = std::min(chart.trial, one.runs.front().key.trial);
  }
  chart.truth = path_of(store, {cell.cell, chart.trial, kDeadReckoning}, "truth_x_m", "truth_y_m");
  for (const EstimatorResults& one : cell.estimators) {
    const RunKey key{cell.cell, chart.trial, one.name};
    Points path = path_of(store, key, "x_m", "y_m");
    if (path.empty()) continue;
    if (one.name != kDeadReckoning && chart.loops_of.empty()) add_loops(chart, store, key, path);
    chart.paths.emplace_back(one.name, std::move(path));
  }
  return chart;
}

// The same scale along both axes: x up, y to the left, which is an axis from high to low.
ChartFrame frame_of(const TrajectoryChart& chart, const Box& box) {
  std::vector<double> xs;
  std::vector<double> ys;
  const auto add = [&](const Points& points) {
    for (const Eigen::Vector2d& point : points) {
      xs.push_back(point.x());
      ys.push_back(point.y());
    }
  };
  add(chart.truth);
  for (const auto& [name, points] : chart.paths) add(points);
  const auto [x0, x1] = std::minmax_element(xs.begin(), xs.end());
  const auto [y0, y1] = std::minmax_element(ys.begin(), ys.end());
  const double scale = 1.08 * std::max({(*x1 - *x0) / box.height, (*y1 - *y0) / box.width, 1e-6});
  const auto around = [scale](double low, double high, double points) {
    const double middle = 0.5 * (low + high);
    return std::vector<double>{middle - 0.5 * scale * points, middle + 0.5 * scale * points};
  };
  ChartAxis across = axis_over("y (m)", around(*y0, *y1, box.width), false);
  std::swap(across.low, across.high);
  return {std::move(across), axis_over("x (m)", around(*x0, *x1, box.height), false), box};
}

Points placed(const ChartFrame& frame, const Points& world) {
  Points points;
  for (const Eigen::Vector2d& point : world) points.push_back(frame.at(point.y(), point.x()));
  return points;
}

void draw_trajectories(VectorCanvas& canvas, const TrajectoryChart& chart,
                       const StudyDescription& study, const std::string& caption, double height) {
  const ChartFrame frame = frame_of(chart, axes_box(height));
  const auto styles = line_styles(study);
  frame.draw(canvas);
  std::vector<FigureLegendEntry> legend;
  if (!chart.loops.empty()) {
    const Pen thin{styles.at(chart.loops_of).colour, 0.3, {}, 0.5};
    for (const Points& loop : chart.loops) canvas.line(placed(frame, loop), thin);
  }
  if (!chart.truth.empty()) {
    const Pen pen{palette::black, 1.6, {}, 1.0};
    canvas.line(placed(frame, chart.truth), pen);
    legend.push_back({"ground truth", pen});
  }
  for (const auto& [name, points] : chart.paths) {
    const Pen pen = pen_of(styles.at(name), 1.0);
    canvas.line(placed(frame, points), pen);
    legend.push_back({display_name(name), pen});
  }
  if (!chart.loops.empty()) {
    legend.push_back(
        {"loops of " + chart.loops_of, {styles.at(chart.loops_of).colour, 0.4, {}, 0.6}});
  }
  draw_footer(canvas, frame.box(), legend, caption);
}

}  // namespace

void add_trajectory_figures(const FigureInput& input, std::vector<StudyFigure>& figures) {
  const StudyResults& results = input.results;
  for (const CellResults& cell : results.cells) {
    const TrajectoryChart chart = chart_of(input.store, cell);
    if (chart.paths.empty()) continue;
    const std::string caption =
        "trial " + std::to_string(chart.trial) + " of " + cell_caption(cell, results.study);
    constexpr double kHeight = 270.0;
    figures.push_back({figure_name("trajectories", cell.label, results.cells.size() == 1), kHeight,
                       [chart, caption, &study = results.study](VectorCanvas& canvas) {
                         draw_trajectories(canvas, chart, study, caption, kHeight);
                       }});
  }
}

}  // namespace fathom
