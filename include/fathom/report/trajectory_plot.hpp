#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/measured_parts.hpp"
#include "fathom/report/palette.hpp"

namespace fathom {

/// An absolute measurement of a pose of a trajectory, drawn in grey: a fix is a ring where it says
/// that the pose is, joined to it; a heading a short line from the pose. What was left out (by a
/// gate, or by a loss to half of its weight or less) is red: the ring a ×, the line with a bar.
struct AbsoluteMark {
  std::size_t pose = 0;  ///< index into the poses of its series
  MeasuredParts measured;
  bool is_kept = true;
};

/// What a measurement of a log says, drawn on a trajectory of all keyframes.
AbsoluteMark absolute_mark(const AbsolutePose& measurement, bool is_kept);

/// One trajectory of a picture.
struct PlotSeries {
  std::string name;
  LineStyle style;
  std::vector<Pose> poses;  ///< metres, world frame
  /// Of (x, y, θ) of each pose in world axes, or none at all. 2σ ellipses of the position are drawn
  /// at some of the poses; a covariance that is not finite or not positive has no ellipse.
  std::vector<Eigen::Matrix3d> covariances;
  /// Loop closures as pairs of indices into `poses`, drawn as thin lines.
  std::vector<std::pair<std::size_t, std::size_t>> loops;
  /// Dead reckoning, or a run that failed: where it is so far off that the others could not be
  /// seen, it leaves the picture, and the legend says so.
  bool may_leave = false;
  /// Of many some are drawn, evenly spread, first of all what was left out; the legend says so.
  std::vector<AbsoluteMark> absolute{};
  std::string absolute_of{};  ///< whose they are, in the legend; empty: there is one estimate
};

struct TrajectoryPlot {
  std::string title;
  std::vector<PlotSeries> series;  ///< later ones are drawn over earlier, broader ones
  int max_ellipses = 25;           ///< of one series
};

/// Estimates differ in what they left out, not in what was measured: of all series with absolute
/// measurements the first that left one out keeps them, else the first.
void keep_one_set_of_marks(std::vector<PlotSeries>& series);

/// A map with x up, y to the left and equal axes: a PNG of its shape, 1000 to 1600 pixels wide and
/// 800 to 1600 high.
/// Poses that are not finite, or beyond 1e9 m, are left out of the line, which is broken there, and
/// counted in the title. A series without poses stands in the legend as empty.
/// Throws InputError on covariances that are neither none nor one per pose, and on a loop between
/// poses, or a measurement of a pose, that are not there.
std::string trajectory_png(const TrajectoryPlot& plot);

/// The same map as an SVG of 480 × 360 points, for a page that has text beside it.
std::string trajectory_svg(const TrajectoryPlot& plot);

}  // namespace fathom
