#include <algorithm>
#include <cstdio>

#include "maps.hpp"
#include "src/report/chart_frame.hpp"
#include "src/report/chart_legend.hpp"
#include "src/report/figure_file.hpp"

namespace fathom::benchmarks {
namespace {

using Points = std::vector<Eigen::Vector2d>;

constexpr PageSize kPage{520.0, 280.0};
// What the dashed line takes a processor to do: multiply-adds of one factorisation a second.
constexpr double kRate = 1e10;

std::string number(double value) {
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
                     number(1e-9 * bound.multiply_adds) + " | " + number(bound.factor_mib);
  for (const auto& solve : cost.solves) {
    text += solve ? " | " + number(solve->seconds) + " | " + number(solve->cpu_s) + " | " +
                        number(solve->mib)
                  : " | – | – | –";
    if (solve && solve->outcome != "converged") text += " (" + solve->outcome + ")";
  }
  return text + " |\n";
}

Pen pen_of(std::size_t place) {
  const LineStyle style = estimator_style(place);
  return {style.colour, 1.4, style.dashes, 1.0};
}

const Pen& bound_pen() {
  static const Pen pen{kSoftInk, 0.8, {2.0, 2.0}, 1.0};
  return pen;
}

// The bound first, then each solver.
std::vector<Points> curves_of(const std::vector<MapCost>& costs, const std::string& shape) {
  std::vector<Points> curves(1);
  for (const MapCost& cost : costs) {
    if (cost.shape != shape) continue;
    curves.resize(cost.solves.size() + 1);
    const auto keyframes = static_cast<double>(cost.bound.keyframes);
    curves[0].emplace_back(keyframes, cost.bound.multiply_adds / kRate);
    for (std::size_t i = 0; i < cost.solves.size(); ++i) {
      if (cost.solves[i]) curves[i + 1].emplace_back(keyframes, cost.solves[i]->seconds);
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
                         logarithmic_axis_over({"batch solve", "s"}, ys), box);
  frame.draw(canvas);
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Points line = frame.at(curves[i]);
    const Pen pen = i == 0 ? bound_pen() : pen_of(i - 1);
    if (line.size() > 1) canvas.line(line, pen);
    if (i == 0) continue;
    for (const Eigen::Vector2d& point : line) canvas.disc(point, 1.8, pen.colour);
  }
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
  return render_figure(FigureFormat::svg, kPage, [&](Canvas& canvas) {
    draw(canvas, curves_of(costs, kShapes[0]), "keyframes, survey", {12.0, 12.0, 240.0, 216.0});
    draw(canvas, curves_of(costs, kShapes[1]), "keyframes, city", {268.0, 12.0, 240.0, 216.0});
    std::vector<LegendEntry> entries;
    for (std::size_t i = 0; i < solvers.size(); ++i) {
      std::string name = solvers[i].name();
      std::erase(name, '`');
      entries.push_back(line_entry(name, pen_of(i)));
    }
    entries.push_back(
        line_entry("multiply-adds of one factorisation at 10 a nanosecond", bound_pen()));
    ChartLegend(std::move(entries), kPage.width - 24.0).draw(canvas, {12.0, 238.0});
  });
}

}  // namespace fathom::benchmarks
