#pragma once

#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "fathom/datasets/frame_source.hpp"
#include "floor_renderer.hpp"
#include "world.hpp"

namespace fathom {

/// What the views of a mission see of the floor: boxes in the axes of the world's picture with the
/// origin at frame 0, in metres.
struct SeenFloor {
  std::vector<Eigen::AlignedBox2d> boxes;  ///< one per view
  Eigen::AlignedBox2d all;
};

/// Throws InputError that names `prefix` + "attitude" where a tilt lets the camera see the horizon.
SeenFloor seen_floor(const ViewRays& rays, const std::vector<View>& views,
                     const WorldOptions& options, const std::string& prefix);

/// Throws InputError that names `prefix` + "world.picture" and the first frame whose view leaves
/// the world. `infos` are those of the views.
void require_inside(const WorldPlan& world, const SeenFloor& seen,
                    const std::vector<FrameInfo>& infos, const std::string& prefix);

}  // namespace fathom
