#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/measurements/absolute_pose.hpp"
#include "fathom/report/palette.hpp"

namespace fathom {

/// An absolute measurement of a pose of a trajectory: a fix is a cross where it says that the pose
/// is, joined to it; a heading a short line from the pose. What was not used is red.
struct AbsoluteMark {
  std::size_t pose = 0;  ///< index into the poses of its series
  std::optional<Eigen::Vector2d> position;
  std::optional<double> heading_rad;
  bool is_used = true;
};

/// What an absolute measurement says, drawn.
AbsoluteMark absolute_mark(const AbsolutePose& measurement, bool is_used);

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
  std::vector<AbsoluteMark> absolute{};
};

struct TrajectoryPlot {
  std::string title;
  std::vector<PlotSeries> series;  ///< later ones are drawn over earlier, broader ones
  int max_ellipses = 25;           ///< of one series
};

/// A map with x up, y to the left and equal axes: a PNG of 1600 × 1200 pixels.
/// Poses that are not finite, or beyond 1e9 m, are left out of the line, which is broken there, and
/// counted in the title. A series without poses stands in the legend as empty.
/// Throws InputError on covariances that are neither none nor one per pose, and on a loop between
/// poses that are not there.
std::string trajectory_png(const TrajectoryPlot& plot);

}  // namespace fathom
