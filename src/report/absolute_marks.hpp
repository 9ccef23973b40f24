#pragma once

#include <functional>
#include <vector>

#include "canvas.hpp"
#include "chart_legend.hpp"
#include "fathom/report/trajectory_plot.hpp"

namespace fathom {

/// World to page.
using Placed = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

/// Headings are thinned evenly where there are many; what was not used is drawn whole.
void draw_absolute(Canvas& canvas, const Placed& placed, const PlotSeries& series);

/// Those of the marks that there are.
std::vector<LegendEntry> absolute_legend(const std::vector<PlotSeries>& all);

}  // namespace fathom
