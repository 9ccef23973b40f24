#pragma once

#include <string>
#include <vector>

#include "apps/flags.hpp"
#include "fathom/geometry/plane.hpp"
#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {

/// The value of a name of a list of names; throws InputError with the flag and all names.
template <class Value>
Value named(const std::string& flag, const std::string& name,
            const std::vector<std::pair<std::string, Value>>& names) {
  std::string all;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i].first == name) return names[i].second;
    all += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i].first;
  }
  throw InputError(flag + ": expected " + all + ", got '" + name + "'");
}

/// How a trajectory is to be read, as flags say it.
struct TrajectoryFlags {
  std::string format;  ///< empty: by its content
  std::string plane;   ///< empty: the usual one of its format
  std::string times;   ///< of a KITTI trajectory

  SpatialTrajectory read(const std::string& path, const std::string& format_flag) const;
};

/// "x to y s".
std::string span_text(const SpatialTrajectory& trajectory);

/// What looks wrong with a projection, in sentences; `which` is "the estimate", for example.
std::vector<std::string> projection_warnings(const PlaneAxes& axes, const Projection& projection,
                                             const BodyAxes& body, const std::string& which);

/// "xz", or "fit: xy, tilted by 0.031 rad".
std::string plane_text(Plane plane, const PlaneAxes& axes);

/// Rows "plane", heights, roll and pitch: one column of a table of losses.
std::vector<std::string> loss_cells(const std::string& plane, const ProjectionLoss& loss);
const std::vector<std::string>& loss_rows();

/// Whether a trajectory was on the plane but for rounding.
bool is_flat(const ProjectionLoss& loss);

}  // namespace fathom
