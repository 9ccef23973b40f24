#pragma once

#include <vector>

#include <Eigen/Core>

#include "canvas.hpp"
#include "fathom/report/trajectory_plot.hpp"
#include "map_view.hpp"

namespace fathom {

inline constexpr double kLoopTint = 0.35;
inline constexpr double kEllipseTint = 0.75;

/// Finite and not beyond 1e9 m, where a picture tells nothing and its grid could not be labelled.
bool is_drawable(const Pose& pose);

/// The line of each series. Where lines lie on each other all are seen: the earlier is the broader.
std::vector<Stroke> strokes_of(const std::vector<PlotSeries>& all);

/// The 2σ ellipse of the position as a polygon in metres about the origin; empty where the
/// covariance is not finite or not positive.
std::vector<Eigen::Vector2d> two_sigma_ellipse(const Eigen::Matrix3d& covariance);

/// Loops below, then lines, ellipses and the marks of start and ends.
void draw_series(Canvas& canvas, const MapView& view, const TrajectoryPlot& plot);

}  // namespace fathom
