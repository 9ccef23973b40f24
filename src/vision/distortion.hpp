#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

namespace fathom {

/// k1 k2 p1 p2 k3.
using Distortion = std::array<double, 5>;

/// Brown's radial-tangential distortion of an ideal image point (x, y) = (X/Z, Y/Z), as OpenCV
/// defines it; optionally its 2×2 Jacobian.
Eigen::Vector2d distort(const Distortion& distortion, const Eigen::Vector2d& ideal,
                        Eigen::Matrix2d* distorted_ideal = nullptr);

/// The ideal point behind a distorted one, to 1e-12, on the branch that holds the image centre.
/// Nothing where there is none.
std::optional<Eigen::Vector2d> undistort(const Distortion& distortion,
                                         const Eigen::Vector2d& distorted);

}  // namespace fathom
