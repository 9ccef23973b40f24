#pragma once

#include <optional>
#include <span>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// The paper's find_motion (equations 1 to 3): the roto-translation z that minimises
/// Σ ‖p_j − z ⊕ q_j‖² in closed form. `p` are points seen in `from`, `q` the same points seen in
/// `to`, so z is the pose of `to` in the frame of `from`. The minimum is over rotations alone, so
/// it is never a reflection.
///
/// Nothing for fewer than two points, for NaN, and where no heading is better than another: all
/// points of a side in one place, or, say, a square against its mirror image. Throws InputError
/// where the two counts differ.
std::optional<Pose> find_motion(std::span<const Eigen::Vector2d> p,
                                std::span<const Eigen::Vector2d> q);

/// The same with weights: minimises Σ w_j ‖p_j − z ⊕ q_j‖². All positive, one for each pair.
std::optional<Pose> find_motion(std::span<const Eigen::Vector2d> p,
                                std::span<const Eigen::Vector2d> q,
                                std::span<const double> weights);

/// Σ ‖p_j − z ⊕ q_j‖², m².
double squared_error(const Pose& z, std::span<const Eigen::Vector2d> p,
                     std::span<const Eigen::Vector2d> q);

}  // namespace fathom
