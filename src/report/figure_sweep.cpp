#include <algorithm>
#include <map>

#include "fathom/configuration/axis_words.hpp"
#include "fathom/core/text.hpp"
#include "study_figures.hpp"
#include "sweep_lines.hpp"

namespace fathom {
namespace {

ChartAxis sweep_axis(const Sweep& sweep, const StudyAxis& axis) {
  return labelled_axis(title_of(axis), sweep.positions, ticks_of(axis),
                       sweep.is_numeric ? 0.04 : 0.2);
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

// How points are drawn: estimated 2σ is thin with rings, empirical 2σ is broad with discs.
struct PointStyle {
  bool is_estimated = false;
  bool are_joined = true;
  double size = 1.0;
};

void draw_line(Canvas& canvas, const Points& points, const LineStyle& style,
               const PointStyle& how) {
  const auto [is_estimated, are_joined, size] = how;
  const double width = size * (is_estimated ? 0.6 : 1.3);
  const double radius = 1.8 * size;
  if (are_joined) canvas.line(points, pen_of(style, width));
  for (const Eigen::Vector2d& point : points) {
    if (!are_joined && !is_estimated) {
      draw_mark(canvas, point, style);
      continue;
    }
    canvas.disc(point, radius, is_estimated ? palette::white : style.colour);
    if (is_estimated) canvas.ring(point, radius, {style.colour, width, {}, 1.0});
  }
}

// Within the chart: a band that reaches zero has no end on a logarithmic axis. Bars where there is
// nothing between the points.
void draw_band(Canvas& canvas, const ChartFrame& frame, const SweepLine& line,
               const LineStyle& style, bool are_joined) {
  const auto within = [&](Points points) {
    for (Eigen::Vector2d& point : points) {
      point.y() = std::clamp(point.y(), frame.box().top, frame.box().bottom());
    }
    return points;
  };
  Points band = within(frame.at(line.low));
  const Points high = within(frame.at(line.high));
  if (are_joined) {
    band.insert(band.end(), high.rbegin(), high.rend());
    return canvas.area(band, style.colour, 0.13);
  }
  for (std::size_t i = 0; i < band.size(); ++i) canvas.line(band[i], high[i], pen_of(style, 0.8));
}

// Later ones are smaller, so that those below them can be seen.
void draw_lines(Canvas& canvas, const std::vector<SweepLine>& lines,
                const std::map<std::string, LineStyle>& styles,
                const std::vector<ChartFrame>& frames, bool are_joined) {
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const LineStyle& style = styles.at(lines[i].estimator);
    const double size =
        lines[i].estimator == kDeadReckoning
            ? 1.0
            : 1.0 + static_cast<double>(lines.size() - 1 - i) / static_cast<double>(lines.size());
    draw_line(canvas, frames[0].at(lines[i].mean), style, {false, are_joined, size});
    if (frames.size() == 1) continue;
    draw_line(canvas, frames[1].at(lines[i].empirical), style, {false, are_joined, size});
    draw_line(canvas, frames[1].at(lines[i].estimated), style, {true, are_joined, size});
  }
}

// What all points have in common: the place on the other axes, and the conditions that are not
// swept.
std::string common_conditions(const ChartInput& input, const Sweep& sweep) {
  const StudyDescription& study = input.results.study;
  const CellResults& first = input.results.cells[sweep.cells.front()];
  const auto places = study.places_of(first.cell);
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const StudyAxis& axis = study.axes[i];
    if (i != sweep.axis && axis.labels.size() > 1) parts.push_back(text_of(axis, places[i]));
  }
  std::vector<std::string> conditions = caption_parts(first);
  std::vector<const CellResults*> cells;
  std::size_t failures = 0;
  for (const std::size_t place : sweep.cells) {
    const CellResults& cell = *cells.emplace_back(&input.results.cells[place]);
    std::erase_if(conditions, [own = caption_parts(cell)](const std::string& one) {
      return std::ranges::find(own, one) == own.end();
    });
    for (const EstimatorResults& one : cell.estimators) failures += one.failures();
  }
  if (std::ranges::find(conditions, first.repeats) == conditions.end()) {
    conditions.push_back(repeats_of(cells));
  }
  parts.insert(parts.end(), conditions.begin(), conditions.end());
  parts.push_back(std::string(sweep.is_numeric ? "band" : "bar") +
                  ": mean ± 2 standard deviations over trials");
  std::string text = joined(parts, ", ");
  if (failures > 0) text += "; " + std::to_string(failures) + " failed runs left out";
  return text;
}

LegendEntry sample_entry(const std::string& text, bool is_estimated) {
  return {text, [is_estimated](Canvas& canvas, const Eigen::Vector2d& centre) {
            const Eigen::Vector2d half(6.0, 0.0);
            draw_line(canvas, {centre - half, centre, centre + half}, {kSoftInk, {}},
                      {.is_estimated = is_estimated});
          }};
}

std::vector<LegendEntry> legend_of(const std::vector<SweepLine>& lines,
                                   const std::map<std::string, LineStyle>& styles, bool bounds,
                                   bool are_joined) {
  std::vector<LegendEntry> legend;
  legend.reserve(lines.size() + 1);
  for (const SweepLine& line : lines) {
    if (line.mean.empty() && line.empirical.empty()) continue;
    const LineStyle& style = styles.at(line.estimator);
    legend.push_back(are_joined ? line_entry(display_name(line.estimator), pen_of(style, 1.3))
                                : mark_entry(display_name(line.estimator), style));
  }
  if (bounds) {
    legend.push_back(sample_entry("empirical", false));
    legend.push_back(sample_entry("estimated", true));
  }
  return legend;
}

StudyFigure sweep_figure(const ChartInput& input, const Sweep& sweep, const std::string& metric) {
  const std::vector<SweepLine> lines = sweep_lines(input, sweep, metric);
  const auto styles = line_styles(input.results.study);
  const auto bounds = heights(lines, {&SweepLine::empirical, &SweepLine::estimated});
  const std::vector<double> charts =
      bounds.empty() ? std::vector{160.0} : std::vector{140.0, 120.0};
  const FigureLayout layout(charts, legend_of(lines, styles, !bounds.empty(), sweep.is_numeric),
                            common_conditions(input, sweep));
  const ChartAxis x = sweep_axis(sweep, input.results.study.axes[sweep.axis]);
  const ChartAxis errors = axis_of(axis_title(metric), heights(lines, {&SweepLine::mean}),
                                   heights(lines, {&SweepLine::low, &SweepLine::high}));
  std::vector<ChartFrame> frames{{x, errors, layout.chart(0)}};
  if (!bounds.empty()) {
    frames.push_back({x, axis_of({"2σ of position", "m"}, bounds, {}), layout.chart(1)});
  }
  return {"", layout.height(), [lines, styles, layout, frames, sweep](Canvas& canvas) {
            for (const ChartFrame& frame : frames) frame.draw(canvas);
            for (const SweepLine& line : lines) {
              draw_band(canvas, frames[0], line, styles.at(line.estimator), sweep.is_numeric);
            }
            draw_lines(canvas, lines, styles, frames, sweep.is_numeric);
            layout.draw_footer(canvas);
          }};
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
