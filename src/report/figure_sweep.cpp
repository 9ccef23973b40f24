#include <algorithm>
#include <cmath>

#include "fathom/core/text.hpp"
#include "metric_label.hpp"
#include "study_figures.hpp"

namespace fathom {
namespace {

using Points = std::vector<Eigen::Vector2d>;

// One estimator along the sweep. NaN-free: a cell that lacks a value has no point.
struct SweepLine {
  std::string estimator;
  Points mean;
  Points low;
  Points high;
  Points empirical;
  Points estimated;
};

struct Sweep {
  std::size_t axis = 0;
  std::vector<std::size_t> cells;  ///< places in the results
  std::vector<double> positions;
};

// Numbers lie where they are, other values side by side.
std::vector<double> positions_of(const std::vector<std::string>& labels) {
  std::vector<double> positions;
  for (const std::string& label : labels) {
    if (const auto number = parse_real(label)) positions.push_back(*number);
  }
  if (positions.size() == labels.size()) return positions;
  positions.clear();
  for (std::size_t i = 0; i < labels.size(); ++i) positions.push_back(static_cast<double>(i));
  return positions;
}

void add_values(SweepLine& line, const EstimatorResults& one, const EstimatorSeries& series,
                const std::string& metric, double x) {
  if (const auto found = one.metrics.find(metric); found != one.metrics.end()) {
    const Moments& moments = found->second.moments;
    const double spread = 2.0 * moments.standard_deviation.value_or(0.0);
    line.mean.emplace_back(x, moments.mean);
    line.low.emplace_back(
        x, moments.mean < 0.0 ? moments.mean - spread : std::max(0.0, moments.mean - spread));
    line.high.emplace_back(x, moments.mean + spread);
  }
  if (!series.bounds) return;
  line.empirical.emplace_back(x, series.bounds->empirical_m);
  if (series.bounds->estimated_m) line.estimated.emplace_back(x, *series.bounds->estimated_m);
}

std::vector<SweepLine> lines_of(const FigureInput& input, const Sweep& sweep,
                                const std::string& metric) {
  std::vector<SweepLine> lines;
  for (const std::size_t place : sweep.cells) {
    const CellResults& cell = input.results.cells[place];
    const double x = sweep.positions[input.results.study.places_of(cell.cell)[sweep.axis]];
    for (std::size_t i = 0; i < cell.estimators.size(); ++i) {
      auto line = std::find_if(lines.begin(), lines.end(), [&](const auto& known) {
        return known.estimator == cell.estimators[i].name;
      });
      if (line == lines.end()) {
        line = lines.insert(line, SweepLine{cell.estimators[i].name, {}, {}, {}, {}, {}});
      }
      add_values(*line, cell.estimators[i], input.series[place][i], metric, x);
    }
  }
  return lines;
}

ChartAxis sweep_axis(const Sweep& sweep, const StudyAxis& axis) {
  ChartAxis x = axis_over(axis.name, sweep.positions, false);
  const bool numeric = parse_real(axis.labels.front()).has_value();
  const double margin = (numeric ? 0.04 : 0.2) * (x.high - x.low);
  x.low -= margin;
  x.high += margin;
  x.ticks.clear();
  for (std::size_t i = 0; i < sweep.positions.size(); ++i) {
    x.ticks.emplace_back(sweep.positions[i], axis.labels[i]);
  }
  return x;
}

Points placed(const ChartFrame& frame, const Points& values) {
  Points points;
  for (const Eigen::Vector2d& value : values) points.push_back(frame.at(value.x(), value.y()));
  return points;
}

std::vector<double> heights(const std::vector<SweepLine>& lines,
                            const std::vector<Points SweepLine::*>& members) {
  std::vector<double> values;
  for (const SweepLine& line : lines) {
    for (const auto member : members) {
      for (const Eigen::Vector2d& point : line.*member) values.push_back(point.y());
    }
  }
  return values;
}

void draw_line(VectorCanvas& canvas, const Points& points, const Pen& pen) {
  canvas.line(points, pen);
  for (const Eigen::Vector2d& point : points) canvas.disc(point, 1.6, pen.colour);
}

void draw_sweep(VectorCanvas& canvas, const FigureInput& input, const Sweep& sweep,
                const std::string& metric) {
  const std::vector<SweepLine> lines = lines_of(input, sweep, metric);
  const auto styles = line_styles(input.results.study);
  const ChartAxis x = sweep_axis(sweep, input.results.study.axes[sweep.axis]);
  const Box upper{38.0, 8.0, kFigureWidth - 48.0, 120.0};
  const Box lower{38.0, 166.0, kFigureWidth - 48.0, 100.0};
  const ChartFrame errors(x,
                          axis_over(metric_label(metric).with_unit(),
                                    heights(lines, {&SweepLine::low, &SweepLine::high}), true),
                          upper);
  const auto bounds = heights(lines, {&SweepLine::empirical, &SweepLine::estimated});
  const ChartFrame spreads(x, axis_over("2σ of position (m)", bounds, true), lower);
  errors.draw(canvas);
  if (!bounds.empty()) spreads.draw(canvas);
  std::vector<FigureLegendEntry> legend;
  for (const SweepLine& line : lines) {
    const Pen pen = pen_of(styles.at(line.estimator), 1.3);
    Points band = placed(errors, line.low);
    const Points high = placed(errors, line.high);
    band.insert(band.end(), high.rbegin(), high.rend());
    canvas.area(band, pen.colour, 0.13);
    draw_line(canvas, placed(errors, line.mean), pen);
    draw_line(canvas, placed(spreads, line.empirical), pen);
    Pen dashed = pen;
    dashed.dashes = {3.0, 2.0};
    draw_line(canvas, placed(spreads, line.estimated), dashed);
    legend.push_back({display_name(line.estimator), pen});
  }
  legend.push_back({"empirical", {kSoftInk, 1.0, {}, 1.0}});
  legend.push_back({"estimated", {kSoftInk, 1.0, {3.0, 2.0}, 1.0}});
  const CellResults& first = input.results.cells[sweep.cells.front()];
  std::string caption = "first of " + std::to_string(sweep.cells.size()) +
                        " points: " + cell_caption(first, input.results.study);
  std::size_t failures = 0;
  for (const std::size_t place : sweep.cells) {
    for (const EstimatorResults& one : input.results.cells[place].estimators) {
      failures += one.failures();
    }
  }
  if (failures > 0) caption += "; " + std::to_string(failures) + " failed runs left out";
  draw_footer(canvas, lower, legend, caption);
}

// The cells that share their places on every other axis.
std::vector<Sweep> sweeps_along(std::size_t axis, const StudyResults& results) {
  std::map<std::vector<std::size_t>, Sweep> sweeps;
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    std::vector<std::size_t> others = results.study.places_of(results.cells[i].cell);
    others[axis] = 0;
    Sweep& sweep = sweeps[others];
    sweep.axis = axis;
    sweep.positions = positions_of(results.study.axes[axis].labels);
    sweep.cells.push_back(i);
  }
  std::vector<Sweep> list;
  for (auto& [others, sweep] : sweeps) {
    if (sweep.cells.size() > 1) list.push_back(std::move(sweep));
  }
  return list;
}

std::string name_of_others(const Sweep& sweep, const StudyResults& results) {
  const StudyDescription& study = results.study;
  const auto places = study.places_of(results.cells[sweep.cells.front()].cell);
  std::string name;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i != sweep.axis) name += " " + study.axes[i].name + " " + study.axes[i].labels[places[i]];
  }
  return name;
}

}  // namespace

void add_sweep_figures(const FigureInput& input, std::vector<StudyFigure>& figures) {
  const auto metric = first_metric(input.results, false);
  if (!metric) return;
  for (std::size_t axis = 0; axis < input.results.study.axes.size(); ++axis) {
    for (const Sweep& sweep : sweeps_along(axis, input.results)) {
      const std::string label =
          input.results.study.axes[axis].name + name_of_others(sweep, input.results);
      figures.push_back({figure_name("error_by", label, false), 326.0,
                         [&input, sweep, metric](VectorCanvas& canvas) {
                           draw_sweep(canvas, input, sweep, *metric);
                         }});
    }
  }
}

}  // namespace fathom
