#include <algorithm>

#include "fathom/evaluation/consistency.hpp"
#include "study_figures.hpp"

namespace fathom {
namespace {

using Points = std::vector<Eigen::Vector2d>;

struct NeesChart {
  std::vector<std::pair<std::string, Points>> lines;
  Points low;  ///< of the χ² interval, of the estimator with the most trials
  Points high;
};

NeesChart chart_of(const CellResults& cell, const std::vector<EstimatorSeries>& series) {
  NeesChart chart;
  std::size_t most = 0;
  for (std::size_t i = 0; i < cell.estimators.size(); ++i) {
    const KeyframeStatistics& all = series[i].keyframes;
    Points points;
    for (std::size_t k = 0; k < all.keyframe.size(); ++k) {
      const double x = static_cast<double>(all.keyframe[k]);
      if (all.anees[k] && *all.anees[k] > 0.0) points.emplace_back(x, *all.anees[k]);
    }
    if (points.empty()) continue;
    chart.lines.emplace_back(cell.estimators[i].name, std::move(points));
    const std::size_t trials = *std::max_element(all.nees_count.begin(), all.nees_count.end());
    if (trials <= most) continue;
    most = trials;
    chart.low.clear();
    chart.high.clear();
    for (std::size_t k = 0; k < all.keyframe.size(); ++k) {
      if (all.nees_count[k] == 0) continue;
      const Interval interval = anees_interval(all.nees_count[k], 3, 0.95);
      chart.low.emplace_back(static_cast<double>(all.keyframe[k]), interval.low);
      chart.high.emplace_back(static_cast<double>(all.keyframe[k]), interval.high);
    }
  }
  return chart;
}

Points placed(const ChartFrame& frame, const Points& values) {
  Points points;
  for (const Eigen::Vector2d& value : values) points.push_back(frame.at(value.x(), value.y()));
  return points;
}

ChartFrame frame_of(const NeesChart& chart, double height) {
  std::vector<double> keyframes;
  std::vector<double> values;
  const auto add = [&](const Points& points) {
    for (const Eigen::Vector2d& point : points) {
      keyframes.push_back(point.x());
      values.push_back(point.y());
    }
  };
  for (const auto& [name, points] : chart.lines) add(points);
  add(chart.low);
  add(chart.high);
  return {axis_over("keyframe", keyframes, false),
          logarithmic_axis_over("NEES / 3, mean over trials", values), axes_box(height)};
}

void draw_nees(VectorCanvas& canvas, const NeesChart& chart, const StudyDescription& study,
               const std::string& caption, double height) {
  const ChartFrame frame = frame_of(chart, height);
  const auto styles = line_styles(study);
  Points band = placed(frame, chart.low);
  const Points high = placed(frame, chart.high);
  band.insert(band.end(), high.rbegin(), high.rend());
  canvas.area(band, palette::grey, 0.25);
  frame.draw(canvas);
  const double one = frame.at(0.0, 1.0).y();
  canvas.line(Points{{frame.box().left, one}, {frame.box().right(), one}},
              {kSoftInk, 0.7, {1.5, 1.5}, 1.0});
  std::vector<FigureLegendEntry> legend;
  for (const auto& [name, points] : chart.lines) {
    const Pen pen = pen_of(styles.at(name), 1.1);
    canvas.line(placed(frame, points), pen);
    legend.push_back({display_name(name), pen});
  }
  legend.push_back({"95 % interval of χ²", {palette::grey, 6.0, {}, 0.35}});
  draw_footer(canvas, frame.box(), legend, caption);
}

}  // namespace

void add_nees_figures(const FigureInput& input, std::vector<StudyFigure>& figures) {
  const StudyResults& results = input.results;
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    const NeesChart chart = chart_of(results.cells[i], input.series[i]);
    if (chart.lines.empty()) continue;
    const std::string caption =
        cell_caption(results.cells[i], results.study) + failures_text(results.cells[i]);
    constexpr double kHeight = 220.0;
    figures.push_back({figure_name("nees", results.cells[i].label, results.cells.size() == 1),
                       kHeight, [chart, caption, &study = results.study](VectorCanvas& canvas) {
                         draw_nees(canvas, chart, study, caption, kHeight);
                       }});
  }
}

}  // namespace fathom
