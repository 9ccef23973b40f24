#include "apps/trajectories.hpp"

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

SpatialTrajectory TrajectoryFlags::read(const std::string& path,
                                        const std::string& format_flag) const {
  TrajectorySource source{path, {}, times};
  if (!format.empty()) source.format = named(format_flag, format, trajectory_format_names());
  return read_trajectory(source);
}

std::string span_text(const SpatialTrajectory& trajectory) {
  const auto& poses = trajectory.poses;
  return seconds_text(poses.front().time_ns) + " to " + seconds_text(poses.back().time_ns) + " s";
}

}  // namespace fathom
