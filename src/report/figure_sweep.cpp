#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "fathom/configuration/axis_words.hpp"
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
  if (auto numbers = numeric_positions(labels)) return *std::move(numbers);
  std::vector<double> positions;
  for (std::size_t i = 0; i < labels.size(); ++i) positions.push_back(static_cast<double>(i));
  return positions;
}

void add_values(SweepLine& line, const EstimatorResults& one, const EstimatorSeries& series,
                const std::string& metric, double x) {
  if (const auto found = one.metrics.find(metric); found != one.metrics.end()) {
    const Moments& moments = found->second.moments;
    const BandedMean error = banded(moments.mean, moments.standard_deviation);
    line.mean.emplace_back(x, error.mean);
    line.low.emplace_back(x, error.low);
    line.high.emplace_back(x, error.high);
  }
  if (!series.bounds) return;
  line.empirical.emplace_back(x, series.bounds->empirical_m);
  if (series.bounds->estimated_m) line.estimated.emplace_back(x, *series.bounds->estimated_m);
}

std::vector<SweepLine> lines_of(const ChartInput& input, const Sweep& sweep,
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
  const bool numeric = numeric_positions(axis.labels).has_value();
  return labelled_axis(title_of(axis), sweep.positions, axis.labels, numeric ? 0.04 : 0.2);
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

// Values whose largest is so many times their least have a logarithmic axis: on a linear one
// dead reckoning presses all estimates onto zero.
constexpr double kWideRange = 20.0;

// Of points, and of bands about them that may reach zero and beyond.
ChartAxis axis_of(const AxisTitle& title, const std::vector<double>& points,
                  const std::vector<double>& bands) {
  const auto [least, most] = std::minmax_element(points.begin(), points.end());
  if (!points.empty() && *least > 0.0 && *most > kWideRange * *least) {
    return logarithmic_axis_over(title, points);
  }
  std::vector<double> all = points;
  all.insert(all.end(), bands.begin(), bands.end());
  return axis_over(title, all, true);
}

// Estimated 2σ is thin with rings, empirical 2σ is broad with discs.
void draw_line(Canvas& canvas, const Points& points, const LineStyle& style, bool is_estimated,
               double size = 1.0) {
  const double width = size * (is_estimated ? 0.6 : 1.3);
  const double radius = 1.8 * size;
  canvas.line(points, pen_of(style, width));
  for (const Eigen::Vector2d& point : points) {
    canvas.disc(point, radius, is_estimated ? palette::white : style.colour);
    if (is_estimated) canvas.ring(point, radius, {style.colour, width, {}, 1.0});
  }
}

// Within the chart: a band that reaches zero has no end on a logarithmic axis.
void draw_band(Canvas& canvas, const ChartFrame& frame, const SweepLine& line, Colour colour) {
  Points band = frame.at(line.low);
  const Points high = frame.at(line.high);
  band.insert(band.end(), high.rbegin(), high.rend());
  for (Eigen::Vector2d& point : band) {
    point.y() = std::clamp(point.y(), frame.box().top, frame.box().bottom());
  }
  canvas.area(band, colour, 0.13);
}

// Later ones are smaller, so that those below them can be seen.
void draw_lines(Canvas& canvas, const std::vector<SweepLine>& lines,
                const std::map<std::string, LineStyle>& styles,
                const std::vector<ChartFrame>& frames) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LineStyle& style = styles.at(lines[i].estimator);
    const double size =
        lines[i].estimator == kDeadReckoning
            ? 1.0
            : 1.0 + static_cast<double>(lines.size() - 1 - i) / static_cast<double>(lines.size());
    draw_line(canvas, frames[0].at(lines[i].mean), style, false, size);
    if (frames.size() == 1) continue;
    draw_line(canvas, frames[1].at(lines[i].empirical), style, false, size);
    draw_line(canvas, frames[1].at(lines[i].estimated), style, true, size);
  }
}

std::string conditions_of(const ChartInput& input, const Sweep& sweep) {
  const CellResults& first = input.results.cells[sweep.cells.front()];
  std::string text = fmt::format("first of {} points: {}", sweep.cells.size(), cell_caption(first));
  std::size_t failures = 0;
  for (const std::size_t place : sweep.cells) {
    for (const EstimatorResults& one : input.results.cells[place].estimators) {
      failures += one.failures();
    }
  }
  if (failures > 0) text += "; " + std::to_string(failures) + " failed runs left out";
  return text;
}

LegendEntry sample_entry(const std::string& text, bool is_estimated) {
  return {text, [is_estimated](Canvas& canvas, const Eigen::Vector2d& centre) {
            const Eigen::Vector2d half(6.0, 0.0);
            draw_line(canvas, {centre - half, centre, centre + half}, {kSoftInk, {}}, is_estimated);
          }};
}

std::vector<LegendEntry> legend_of(const std::vector<SweepLine>& lines,
                                   const std::map<std::string, LineStyle>& styles, bool bounds) {
  std::vector<LegendEntry> legend;
  legend.reserve(lines.size() + 1);
  for (const SweepLine& line : lines) {
    if (line.mean.empty() && line.empirical.empty()) continue;
    legend.push_back(
        line_entry(display_name(line.estimator), pen_of(styles.at(line.estimator), 1.3)));
  }
  if (bounds) {
    legend.push_back(sample_entry("empirical", false));
    legend.push_back(sample_entry("estimated", true));
  }
  return legend;
}

StudyFigure sweep_figure(const ChartInput& input, const Sweep& sweep, const std::string& metric) {
  const std::vector<SweepLine> lines = lines_of(input, sweep, metric);
  const auto styles = line_styles(input.results.study);
  const auto bounds = heights(lines, {&SweepLine::empirical, &SweepLine::estimated});
  const std::vector<double> charts =
      bounds.empty() ? std::vector{160.0} : std::vector{140.0, 120.0};
  const FigureLayout layout(charts, legend_of(lines, styles, !bounds.empty()),
                            conditions_of(input, sweep));
  const ChartAxis x = sweep_axis(sweep, input.results.study.axes[sweep.axis]);
  const ChartAxis errors = axis_of(axis_title(metric), heights(lines, {&SweepLine::mean}),
                                   heights(lines, {&SweepLine::low, &SweepLine::high}));
  std::vector<ChartFrame> frames{{x, errors, layout.chart(0)}};
  if (!bounds.empty()) {
    frames.push_back({x, axis_of({"2σ of position", "m"}, bounds, {}), layout.chart(1)});
  }
  return {"", layout.height(), [lines, styles, layout, frames](Canvas& canvas) {
            for (const ChartFrame& frame : frames) frame.draw(canvas);
            for (const SweepLine& line : lines) {
              draw_band(canvas, frames[0], line, styles.at(line.estimator).colour);
            }
            draw_lines(canvas, lines, styles, frames);
            layout.draw_footer(canvas);
          }};
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

void add_sweep_figures(const ChartInput& input, std::vector<StudyFigure>& figures) {
  const auto metric = accuracy_shown(input.results);
  if (!metric) return;
  for (std::size_t axis = 0; axis < input.results.study.axes.size(); ++axis) {
    for (const Sweep& sweep : sweeps_along(axis, input.results)) {
      const std::string label =
          input.results.study.axes[axis].name + name_of_others(sweep, input.results);
      figures.push_back(sweep_figure(input, sweep, *metric));
      figures.back().name = figure_title("error_by", label, false);
    }
  }
}

}  // namespace fathom
