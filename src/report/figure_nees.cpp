#include <map>

#include "study_figures.hpp"

namespace fathom {
namespace {

using NeesPoints = NeesChart::Points;

ChartFrame frame_of(const NeesChart& chart, const Box& outer) {
  std::vector<double> keyframes;
  std::vector<double> values;
  const auto add = [&](const NeesPoints& points) {
    for (const Eigen::Vector2d& point : points) {
      keyframes.push_back(point.x());
      values.push_back(point.y());
    }
  };
  for (const auto& [name, points] : chart.lines) add(points);
  add(chart.low);
  add(chart.high);
  return {axis_over({"keyframe", ""}, keyframes, false),
          logarithmic_axis_over({"NEES / 3, mean over trials", ""}, values), outer};
}

std::vector<LegendEntry> legend_of(const NeesChart& chart,
                                   const std::map<std::string, LineStyle>& styles) {
  std::vector<LegendEntry> legend;
  for (const auto& [name, points] : chart.lines) {
    legend.push_back(line_entry(display_name(name), pen_of(styles.at(name), 1.1)));
  }
  legend.push_back(line_entry("95 % interval of χ², " + std::to_string(chart.draws) +
                                  (chart.draws == 1 ? " draw" : " independent draws"),
                              {palette::grey, 6.0, {}, 0.35}));
  return legend;
}

void draw_nees(Canvas& canvas, const NeesChart& chart, const ChartFrame& frame,
               const std::map<std::string, LineStyle>& styles) {
  NeesPoints band = frame.at(chart.low);
  const NeesPoints high = frame.at(chart.high);
  band.insert(band.end(), high.rbegin(), high.rend());
  canvas.area(band, palette::grey, 0.25);
  frame.draw(canvas);
  const double one = frame.at(0.0, 1.0).y();
  canvas.line({frame.box().left, one}, {frame.box().right(), one},
              {kSoftInk, 0.7, {1.5, 1.5}, 1.0});
  for (const auto& [name, points] : chart.lines) {
    canvas.line(frame.at(points), pen_of(styles.at(name), 1.1));
    if (points.size() == 1) {
      canvas.disc(frame.at(points[0].x(), points[0].y()), 2.0, styles.at(name).colour);
    }
  }
}

}  // namespace

void add_nees_figures(const ChartInput& input, std::vector<StudyFigure>& figures) {
  const StudyResults& results = input.results;
  const auto styles = line_styles(results.study);
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    const CellResults& cell = results.cells[i];
    const NeesChart chart = nees_chart(cell, input.series[i]);
    if (chart.lines.empty()) continue;
    const FigureLayout layout({170.0}, legend_of(chart, styles),
                              cell_caption(cell) + failures_text(cell));
    const ChartFrame frame = frame_of(chart, layout.chart(0));
    figures.push_back({figure_title("nees", cell.label, results.cells.size() == 1), layout.height(),
                       [chart, frame, layout, styles](Canvas& canvas) {
                         draw_nees(canvas, chart, frame, styles);
                         layout.draw_footer(canvas);
                       }});
  }
}

}  // namespace fathom
