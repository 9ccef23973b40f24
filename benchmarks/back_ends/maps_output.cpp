#include <algorithm>
#include <cstdio>

#include "curves.hpp"
#include "maps.hpp"
#include "src/report/chart_legend.hpp"
#include "src/report/figure_file.hpp"

namespace fathom::benchmarks {
namespace {

constexpr PageSize kMapPage{520.0, 280.0};
// What the dashed line takes a processor to do: multiply-adds of one factorisation a second.
constexpr double kRate = 1e10;

std::string of_size(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, value < 1e3 ? "%.3g" : "%.0f", value);
  return buffer;
}

std::string header_of(const std::string& shape, const std::vector<MapSolver>& solvers) {
  std::string text =
      "\n| " + shape + ": keyframes | loops | largest separator | 10⁹ multiply-adds | factor, MiB";
  std::string rule = "\n|---|---|---|---|---";
  for (const MapSolver& solver : solvers) {
    text += " | " + solver.name() + ", s | CPU, s | MiB";
    rule += "|---|---|---";
  }
  return text + " |" + rule + "|\n";
}

std::string row_of(const MapCost& cost) {
  const MapBound& bound = cost.bound;
  std::string text = "| " + std::to_string(bound.keyframes) + " | " + std::to_string(bound.loops) +
                     " | " + std::to_string(bound.separator) + " | " +
                     of_size(1e-9 * bound.multiply_adds) + " | " + of_size(bound.factor_mib);
  for (const auto& solve : cost.solves) {
    text += solve ? " | " + of_size(solve->seconds) + " | " + of_size(solve->cpu_s) + " | " +
                        of_size(solve->mib)
                  : " | – | – | –";
    if (solve && solve->outcome != "converged") text += " (" + solve->outcome + ")";
  }
  return text + " |\n";
}

const Pen& bound_pen() {
  static const Pen pen{kSoftInk, 0.8, {2.0, 2.0}, 1.0};
  return pen;
}

// The bound first, then each solver.
std::vector<Curve> curves_of(const std::vector<MapCost>& costs, const std::string& shape) {
  std::vector<Curve> curves{{{}, bound_pen(), false}};
  for (const MapCost& cost : costs) {
    if (cost.shape != shape) continue;
    while (curves.size() < cost.solves.size() + 1) {
      curves.push_back({{}, pen_of(curves.size() - 1)});
    }
    const auto keyframes = static_cast<double>(cost.bound.keyframes);
    curves[0].points.emplace_back(keyframes, cost.bound.multiply_adds / kRate);
    for (std::size_t i = 0; i < cost.solves.size(); ++i) {
      if (cost.solves[i]) curves[i + 1].points.emplace_back(keyframes, cost.solves[i]->seconds);
    }
  }
  return curves;
}

}  // namespace

std::string markdown(const std::vector<MapCost>& costs, const std::vector<MapSolver>& solvers) {
  std::string text;
  for (const std::string& shape : kShapes) {
    text += header_of(shape, solvers);
    for (const MapCost& cost : costs) {
      if (cost.shape == shape) text += row_of(cost);
    }
  }
  return text;
}

std::string chart(const std::vector<MapCost>& costs, const std::vector<MapSolver>& solvers) {
  return render_figure(FigureFormat::svg, kMapPage, [&](Canvas& canvas) {
    draw_curves(canvas, curves_of(costs, kShapes[0]), {"keyframes, survey", ""},
                {"batch solve", "s"}, {12.0, 12.0, 240.0, 216.0});
    draw_curves(canvas, curves_of(costs, kShapes[1]), {"keyframes, city", ""}, {"batch solve", "s"},
                {268.0, 12.0, 240.0, 216.0});
    std::vector<LegendEntry> entries;
    for (std::size_t i = 0; i < solvers.size(); ++i) {
      std::string name = solvers[i].name();
      std::erase(name, '`');
      entries.push_back(line_entry(name, pen_of(i)));
    }
    entries.push_back(
        line_entry("multiply-adds of one factorisation at 10 a nanosecond", bound_pen()));
    ChartLegend(std::move(entries), kMapPage.width - 24.0).draw(canvas, {12.0, 238.0});
  });
}

}  // namespace fathom::benchmarks
