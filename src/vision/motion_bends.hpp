#pragma once

#include <span>
#include <utility>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/features.hpp"

namespace fathom {

/// Second moments of what tilts of `from` and of `to` do to a fitted motion z beyond its responses,
/// to second order, with roll and pitch drawn from N(0, 1 rad²): they go by σ⁴. Of points z ⊕ q and
/// q; axes of `from`. Zero where a picture has no altitude.
std::pair<Eigen::Matrix3d, Eigen::Matrix3d> motion_bends(const Pose& z,
                                                         std::span<const Eigen::Vector2d> q,
                                                         std::span<const double> weights,
                                                         const Viewpoint& from,
                                                         const Viewpoint& to);

}  // namespace fathom
