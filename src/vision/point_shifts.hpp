#pragma once

#include <Eigen/Core>

#include "fathom/vision/features.hpp"

namespace fathom {

/// What the errors of a picture do to a point of the floor seen at p (body frame): its derivative
/// by altitude, roll and pitch.
Eigen::Matrix<double, 2, 3> shift_by_errors(const Viewpoint& view, const Eigen::Vector2d& p);

/// The second derivative by roll (column 0), by pitch (1) and by both (2).
Eigen::Matrix<double, 2, 3> shift_by_tilts(const Viewpoint& view, const Eigen::Vector2d& p);

}  // namespace fathom
