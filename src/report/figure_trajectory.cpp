#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include "study_figures.hpp"

namespace fathom {
namespace {

using Points = std::vector<Eigen::Vector2d>;

struct TrajectoryChart {
  std::size_t trial = 0;
  std::vector<std::pair<std::string, Points>> paths;  ///< (x, y) in metres
  std::set<std::string> strays;  ///< that may lie far off: dead reckoning and runs that failed
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

bool is_done_at(const EstimatorResults& one, std::size_t trial) {
  return std::any_of(one.runs.begin(), one.runs.end(), [trial](const RunRecord& run) {
    return run.key.trial == trial && is_done(run);
  });
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
    if (one.name == kDeadReckoning || !is_done_at(one, chart.trial)) chart.strays.insert(one.name);
    chart.paths.emplace_back(one.name, std::move(path));
  }
  return chart;
}

// All, unless what strays is so far off that the rest could not be seen.
Eigen::AlignedBox2d extent_of(const TrajectoryChart& chart) {
  Eigen::AlignedBox2d near;
  for (const Eigen::Vector2d& point : chart.truth) near.extend(point);
  Eigen::AlignedBox2d all = near;
  for (const auto& [name, points] : chart.paths) {
    for (const Eigen::Vector2d& point : points) {
      all.extend(point);
      if (!chart.strays.contains(name)) near.extend(point);
    }
  }
  const bool far = !near.isEmpty() && all.sizes().maxCoeff() > 2.5 * near.sizes().maxCoeff();
  return far ? near : all;
}

// The same scale along both axes: x up, y to the left, which is an axis from high to low.
ChartFrame frame_of(const TrajectoryChart& chart, const Box& box) {
  const Eigen::AlignedBox2d extent = extent_of(chart);
  const Eigen::Vector2d size = extent.sizes();
  const double scale = 1.08 * std::max({size.x() / box.height, size.y() / box.width, 1e-6});
  const auto around = [scale](double middle, double points) {
    return std::vector<double>{middle - 0.5 * scale * points, middle + 0.5 * scale * points};
  };
  const Eigen::Vector2d centre = extent.center();
  ChartAxis across = axis_over("y (m)", around(centre.y(), box.width), false);
  std::swap(across.low, across.high);
  return {std::move(across), axis_over("x (m)", around(centre.x(), box.height), false), box};
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
  const auto draw = [&](const std::string& label, const Points& points, const Pen& pen) {
    canvas.clipped(frame.box(), [&] { canvas.line(placed(frame, points), pen); });
    if (!label.empty()) legend.push_back({label, pen});
  };
  for (const Points& loop : chart.loops) {
    draw("", loop, {styles.at(chart.loops_of).colour, 0.3, {}, 0.5});
  }
  if (!chart.truth.empty()) draw("ground truth", chart.truth, {palette::black, 1.6, {}, 1.0});
  for (const auto& [name, points] : chart.paths) {
    draw(display_name(name), points, pen_of(styles.at(name), 1.0));
  }
  if (!chart.loops.empty()) {
    const Pen sample{styles.at(chart.loops_of).colour, 0.4, {}, 0.6};
    legend.push_back({"loops of " + chart.loops_of, sample});
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
