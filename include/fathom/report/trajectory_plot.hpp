#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// One trajectory of a picture. Its colour follows from its name (palette.hpp); "dead reckoning" is
/// dashed and "ground truth" a broad line, so that an estimate on top of it leaves it to be seen.
struct PlotSeries {
  std::string name;
  std::vector<Pose> poses;  ///< metres, world frame
  /// Of (x, y, θ) of each pose in world axes, or none at all. 2σ ellipses of the position are drawn
  /// at some of the poses; a covariance that is not finite or not positive has no ellipse.
  std::vector<Eigen::Matrix3d> covariances;
  /// Loop closures as pairs of indices into `poses`, drawn as thin lines.
  std::vector<std::pair<std::size_t, std::size_t>> loops;
};

struct TrajectoryPlot {
  std::string title;
  std::vector<PlotSeries> series;  ///< later ones are drawn over earlier ones
  int width_px = 1600;
  int height_px = 1200;
  int max_ellipses = 25;  ///< of one series
};

/// A map with x up, y to the left and equal axes: an 8-bit BGR picture of the size asked for.
/// Poses that are not finite, or beyond 1e9 m, are left out of the line, which is broken there, and
/// counted in the title. A series without poses stands in the legend as empty.
/// Throws InputError on a size below 400 × 300, covariances that are neither none nor one per pose,
/// or a loop between poses that are not there.
cv::Mat render(const TrajectoryPlot& plot);

}  // namespace fathom
