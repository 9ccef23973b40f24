#pragma once

#include <functional>
#include <vector>

#include <Eigen/Geometry>

#include "canvas.hpp"
#include "chart_legend.hpp"
#include "fathom/report/trajectory_plot.hpp"

namespace fathom {

/// World to page: x up, y to the left.
using Placed = std::function<Eigen::Vector2d(const Eigen::Vector2d&)>;

/// How many marks of one series are drawn at most: more would be one grey or red area.
struct MarkLimits {
  std::size_t fixes = 150;
  std::size_t headings = 60;   ///< alone, without a fix
  std::size_t left_out = 300;  ///< of either kind

  /// The same shares of `most` in all, if that is less.
  MarkLimits within(std::size_t most) const;
};

/// The places of the marks that are drawn, rising: of each kind evenly thinned.
std::vector<std::size_t> drawn_marks(const std::vector<AbsoluteMark>& marks,
                                     const MarkLimits& limits = {});

/// The part of the world to show: that of the poses, and fixes that lie no further from it than a
/// quarter of its size. A jump of a hundred metres must not make a point of the rest.
Eigen::AlignedBox2d with_fixes(const Eigen::AlignedBox2d& poses,
                               const std::vector<PlotSeries>& all);

/// A fix beyond the frame is an arrow head at its edge, where the line to it leaves.
void draw_absolute(Canvas& canvas, const Placed& placed, const Box& frame,
                   const PlotSeries& series);

/// Those of the marks that there are.
std::vector<LegendEntry> absolute_legend(const std::vector<PlotSeries>& all,
                                         const Eigen::AlignedBox2d& shown);

}  // namespace fathom
