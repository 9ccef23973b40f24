#include "study_figures.hpp"

#include <algorithm>
#include <utility>

#include "fathom/evaluation/metrics.hpp"
#include "file_names.hpp"
#include "ranking.hpp"
#include "text_layout.hpp"

namespace fathom {
namespace {

constexpr double kPageMargin = 6.0;
constexpr double kBetween = 6.0;  // charts, legend
constexpr double kSmallSize = 6.0;
constexpr double kSmallLine = 1.3 * kSmallSize;

}  // namespace

std::string figure_title(const std::string& what, const std::string& label, bool alone) {
  return alone ? what : what + " " + label;
}

FigureLayout::FigureLayout(std::vector<double> chart_heights, std::vector<LegendEntry> legend,
                           const std::string& conditions)
    : chart_heights_(std::move(chart_heights)),
      legend_(std::move(legend), kFigureWidth - 2.0 * kPageMargin),
      conditions_(wrapped(conditions, kSmallSize, kFigureWidth - 2.0 * kPageMargin)) {}

double FigureLayout::height() const {
  return footer_top() + legend_.height() + kSmallLine * static_cast<double>(conditions_.size()) +
         kPageMargin;
}

Box FigureLayout::chart(std::size_t place) const {
  double top = kPageMargin;
  for (std::size_t i = 0; i < place; ++i) top += chart_heights_[i] + kBetween;
  return {kPageMargin, top, kFigureWidth - 2.0 * kPageMargin, chart_heights_[place]};
}

double FigureLayout::footer_top() const {
  return chart(chart_heights_.size() - 1).bottom() + kBetween;
}

void FigureLayout::draw_footer(Canvas& canvas) const {
  legend_.draw(canvas, {kPageMargin, footer_top()});
  double baseline = footer_top() + legend_.height() + kSmallSize;
  for (const std::string& line : conditions_) {
    canvas.text(line, {kPageMargin, baseline}, {kSmallSize, kSoftInk});
    baseline += kSmallLine;
  }
}

AxisTitle axis_title(const std::string& metric) {
  const Metric described_metric = described(metric);
  return {described_metric.label, described_metric.unit};
}

std::optional<std::string> first_metric(const StudyResults& results, bool cost) {
  for (const std::string& name : results.study.metrics) {
    if (is_cost_metric(name) != cost) continue;
    for (const CellResults& cell : results.cells) {
      const auto has = [&](const EstimatorResults& one) { return one.metrics.contains(name); };
      if (std::ranges::any_of(cell.estimators, has)) return name;
    }
  }
  return std::nullopt;
}

std::optional<std::string> accuracy_shown(const StudyResults& results) {
  auto ranking = ranking_metric(results).name;
  return ranking ? ranking : first_metric(results, false);
}

std::vector<StudyFigure> study_figures(const ChartInput& input) {
  std::vector<StudyFigure> figures;
  add_sweep_figures(input, figures);
  add_regime_figures(input, figures);
  add_nees_figures(input, figures);
  add_trajectory_figures(input, figures);
  add_cost_figures(input, figures);
  FileNames names;
  for (StudyFigure& figure : figures) figure.name = names.unique(figure.name);
  return figures;
}

}  // namespace fathom
