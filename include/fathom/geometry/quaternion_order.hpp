#pragma once

#include <span>
#include <string>

#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {

/// Throws InputError where the quaternions of a TUM or an EuRoC file `name` look like those of the
/// other order: read in it, nearly all turn about z alone and the heading changes, while the path
/// is level; as they stand, they tilt the body. What moves in space, or about one heading, passes.
void require_order(std::span<const StampedSpatialPose> poses, TrajectoryFormat format,
                   const std::string& name);

}  // namespace fathom
