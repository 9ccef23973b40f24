#pragma once

#include <vector>

#include <Eigen/Core>

#include "chart_frame.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Finite and not beyond 1e9 m, where a picture tells nothing and its grid could not be labelled.
bool is_drawable(const Pose& pose);

/// The axes of a map of that part of the world, with room round it, in a box.
ChartFrame map_frame(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Box& outer);

/// The 2σ ellipse of the position as a polygon in metres about the origin; empty where the
/// covariance is not finite or not positive.
std::vector<Eigen::Vector2d> two_sigma_ellipse(const Eigen::Matrix3d& covariance);

}  // namespace fathom
