#include <array>

#include "curves.hpp"
#include "output.hpp"
#include "src/report/chart_legend.hpp"
#include "src/report/figure_file.hpp"

namespace fathom::benchmarks {
namespace {

constexpr PageSize kPage{520.0, 270.0};

std::vector<Curve> curves_of(const std::vector<LogCosts>& logs, std::size_t LogCosts::*count) {
  std::vector<Curve> curves;
  for (const LogCosts& log : logs) {
    while (curves.size() < log.costs.size()) curves.push_back({{}, pen_of(curves.size())});
    for (std::size_t i = 0; i < log.costs.size(); ++i) {
      if (log.costs[i].gave_up) continue;
      curves[i].points.emplace_back(static_cast<double>(log.*count), log.costs[i].total_ms);
    }
  }
  return curves;
}

}  // namespace

std::string chart(const Growth& growth) {
  return render_figure(FigureFormat::svg, kPage, [&](Canvas& canvas) {
    draw_curves(canvas, curves_of(growth.by_keyframes, &LogCosts::keyframes),
                {"keyframes (a loop for every third)", ""}, {"total", "ms"},
                {12.0, 12.0, 240.0, 216.0});
    draw_curves(canvas, curves_of(growth.by_loops, &LogCosts::loops),
                {"loops (2000 keyframes)", ""}, {"total", "ms"}, {268.0, 12.0, 240.0, 216.0});
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
