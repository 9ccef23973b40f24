#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "chart_frame.hpp"
#include "chart_legend.hpp"
#include "fathom/report/trajectory_plot.hpp"

namespace fathom {

/// The part of the world that a map shows: all poses that can be drawn, unless what may leave is so
/// far off that the rest could not be seen, and the fixes near it. Empty where nothing is.
Eigen::AlignedBox2d map_extent(const std::vector<PlotSeries>& all);

/// Trajectories seen from above with x up and y to the left, the same scale along both: what
/// trajectories.png and the figures for print share.
class TrajectoryMap {
 public:
  explicit TrajectoryMap(const TrajectoryPlot& plot);

  std::vector<LegendEntry> legend() const;
  void draw(Canvas& canvas, const Box& outer) const;

 private:
  bool leaves(const PlotSeries& series) const;

  const TrajectoryPlot& plot_;
  std::vector<Pen> pens_;
  std::vector<Pen> drawn_;  ///< `pens_` but where estimates lie on one another
  bool do_take_turns_ = false;
  Eigen::Vector2d low_;
  Eigen::Vector2d high_;
};

}  // namespace fathom
