#pragma once

#include <optional>

#include <Eigen/Core>

#include "fathom/vision/camera.hpp"

namespace fathom {

/// Where a lens shows an ideal image point (x, y) = (X/Z, Y/Z), in focal lengths from its centre,
/// as OpenCV defines it; optionally the 2×2 Jacobian of that. NaN at the pole of a rational
/// polynomial and beyond.
Eigen::Vector2d distort(const CameraModel& lens, const Eigen::Vector2d& ideal,
                        Eigen::Matrix2d* distorted_ideal = nullptr);

/// The ideal point behind a distorted one, to 1e-12, on the branch that holds the image centre.
/// Nothing where there is none. `reach_rad` is reach_of(lens).
std::optional<Eigen::Vector2d> undistort(const CameraModel& lens, double reach_rad,
                                         const Eigen::Vector2d& distorted);

/// The angle from its axis up to which an equidistant lens shows what is further out further from
/// the centre, at most a quarter turn: a floor is never seen at more. Of other lenses that.
double reach_of(const CameraModel& lens);

/// Whether all points between the image centre and an ideal point are shown one by one.
bool is_unfolded(const CameraModel& lens, const Eigen::Vector2d& ideal);

}  // namespace fathom
