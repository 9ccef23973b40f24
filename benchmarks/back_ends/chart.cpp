#include <array>

#include "output.hpp"
#include "src/report/chart_frame.hpp"
#include "src/report/chart_legend.hpp"
#include "src/report/figure_file.hpp"

namespace fathom::benchmarks {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr PageSize kPage{520.0, 270.0};

Pen pen_of(std::size_t place) {
  const LineStyle style = estimator_style(place);
  return {style.colour, 1.4, style.dashes, 1.0};
}

std::vector<Points> curves_of(const std::vector<LogCosts>& logs, std::size_t LogCosts::*count) {
  std::vector<Points> curves;
  for (const LogCosts& log : logs) {
    curves.resize(std::max(curves.size(), log.costs.size()));
    for (std::size_t i = 0; i < log.costs.size(); ++i) {
      if (log.costs[i].gave_up) continue;
      curves[i].emplace_back(static_cast<double>(log.*count), log.costs[i].total_ms);
    }
  }
  return curves;
}

void draw(Canvas& canvas, const std::vector<Points>& curves, const std::string& title,
          const Box& box) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const Points& curve : curves) {
    for (const Eigen::Vector2d& point : curve) {
      xs.push_back(point.x());
      ys.push_back(point.y());
    }
  }
  if (xs.empty()) return;
  const ChartFrame frame(logarithmic_axis_over({title, ""}, xs),
                         logarithmic_axis_over({"total", "ms"}, ys), box);
  frame.draw(canvas);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Points line = frame.at(curves[i]);
    if (line.size() > 1) canvas.line(line, pen_of(i));
    for (const Eigen::Vector2d& point : line) canvas.disc(point, 1.8, pen_of(i).colour);
  }
}

}  // namespace

std::string chart(const Growth& growth) {
  return render_figure(FigureFormat::svg, kPage, [&](Canvas& canvas) {
    draw(canvas, curves_of(growth.by_keyframes, &LogCosts::keyframes),
         "keyframes (a loop for every third)", {12.0, 12.0, 240.0, 216.0});
    draw(canvas, curves_of(growth.by_loops, &LogCosts::loops), "loops (2000 keyframes)",
         {268.0, 12.0, 240.0, 216.0});
    std::vector<LegendEntry> entries;
    const std::vector<LogCosts>& logs =
        growth.by_keyframes.empty() ? growth.by_loops : growth.by_keyframes;
    for (std::size_t i = 0; !logs.empty() && i < logs.front().costs.size(); ++i) {
      entries.push_back(line_entry(logs.front().costs[i].estimator, pen_of(i)));
    }
    ChartLegend(std::move(entries), kPage.width - 24.0).draw(canvas, {12.0, 238.0});
  });
}

}  // namespace fathom::benchmarks
