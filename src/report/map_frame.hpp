#pragma once

#include <optional>
#include <vector>

#include <Eigen/Core>

#include "chart_frame.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// Finite and not beyond 1e9 m, where a picture tells nothing and its grid could not be labelled.
bool is_drawable(const Pose& pose);

/// The axes of a map of that part of the world, with room round it, in a box.
ChartFrame map_frame(const Eigen::Vector2d& low, const Eigen::Vector2d& high, const Box& outer);

/// The 2σ ellipse of a position with covariance P (m²) is axes · (cos t, sin t), in metres about
/// the origin. Nothing where P is not finite or not positive.
std::optional<Eigen::Matrix2d> two_sigma_axes(const Eigen::Matrix2d& P);

/// The same as a polygon; empty where there is none.
std::vector<Eigen::Vector2d> two_sigma_ellipse(const Eigen::Matrix3d& covariance);

}  // namespace fathom
