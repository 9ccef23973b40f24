#include <map>

#include "ranking.hpp"
#include "study_figures.hpp"

namespace fathom {
namespace {

using Points = std::vector<Eigen::Vector2d>;

ChartFrame frame_of(const std::vector<CostPoint>& points, const std::string& accuracy,
                    const std::string& cost, const Box& outer) {
  std::vector<double> costs;
  std::vector<double> errors;
  for (const CostPoint& point : points) {
    costs.insert(costs.end(), {0.8 * point.costs.low, 1.25 * point.costs.high});
    errors.insert(errors.end(), {point.errors.low, point.errors.high});
  }
  return {logarithmic_axis_over(axis_title(cost), costs),
          axis_over(axis_title(accuracy), errors, true), outer};
}

const Pen& front_pen() {
  static const Pen pen{kSoftInk, 0.7, {2.5, 2.0}, 1.0};
  return pen;
}

std::vector<LegendEntry> legend_of(const std::vector<CostPoint>& points,
                                   const std::map<std::string, LineStyle>& styles, bool front) {
  std::vector<LegendEntry> legend;
  legend.reserve(points.size() + 1);
  for (const CostPoint& point : points) {
    legend.push_back(mark_entry(display_name(point.estimator), styles.at(point.estimator)));
  }
  if (front) legend.push_back(line_entry("Pareto front", front_pen()));
  return legend;
}

void draw_cost(Canvas& canvas, const std::vector<CostPoint>& points,
               const std::vector<CostPoint>& front, const ChartFrame& frame,
               const std::map<std::string, LineStyle>& styles) {
  frame.draw(canvas);
  Points steps;
  for (const CostPoint& point : front) {
    const Eigen::Vector2d at = frame.at(point.cost, point.error);
    if (!steps.empty()) steps.emplace_back(at.x(), steps.back().y());
    steps.push_back(at);
  }
  canvas.line(steps, front_pen());
  for (const CostPoint& point : points) {
    const LineStyle& style = styles.at(point.estimator);
    const Pen pen{style.colour, 1.0, {}, 1.0};
    canvas.line(frame.at(point.costs.low, point.error), frame.at(point.costs.high, point.error),
                pen);
    canvas.line(frame.at(point.cost, point.errors.low), frame.at(point.cost, point.errors.high),
                pen);
    draw_mark(canvas, frame.at(point.cost, point.error), style);
  }
  for (const CostPoint& point : front) {
    canvas.ring(frame.at(point.cost, point.error), 3.6, {palette::black, 0.8, {}, 1.0});
  }
}

}  // namespace

void add_cost_figures(const ChartInput& input, std::vector<StudyFigure>& figures) {
  const StudyResults& results = input.results;
  const auto accuracy = accuracy_shown(results);
  const auto cost = first_metric(results, true);
  if (!accuracy || !cost) return;
  const auto styles = line_styles(results.study);
  for (const CellResults& cell : results.cells) {
    const std::vector<CostPoint> points = cost_points(cell, *accuracy, *cost);
    if (points.empty()) continue;
    std::string conditions = cell_caption(cell) + failures_text(cell) + "; means, 95 % intervals";
    const std::string against = no_ranking_text(cell, *accuracy);
    if (!against.empty()) conditions += "; no Pareto front: " + against;
    const std::vector<CostPoint> front = pareto_front(points, described(*accuracy).better);
    const FigureLayout layout({170.0}, legend_of(points, styles, !front.empty()), conditions);
    const ChartFrame frame = frame_of(points, *accuracy, *cost, layout.chart(0));
    figures.push_back({figure_title("accuracy_against_cost", cell.label, results.cells.size() == 1),
                       layout.height(), [points, front, frame, layout, styles](Canvas& canvas) {
                         draw_cost(canvas, points, front, frame, styles);
                         layout.draw_footer(canvas);
                       }});
  }
}

}  // namespace fathom
