#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/trajectory.hpp"
#include "fathom/geometry/trajectory_file.hpp"

namespace fathom {

/// The plane that a trajectory in space is projected onto. It is named by the axes of the world
/// that span it; forward, left and up are these axes of the world and of the body alike:
enum class Plane {
  xy,   ///< x, y, z: what most use, z up
  xz,   ///< z, −x, −y: a camera's axes, z forward and y down, as those of KITTI
  yz,   ///< y, z, x
  fit,  ///< the plane of least squares, its axes those of the named plane next to it, tilted by the
        ///< smallest rotation
};

/// Every plane with the name it has in flags.
const std::vector<std::pair<std::string, Plane>>& plane_names();
std::string name_of(Plane plane);

/// The plane of a format's own axes: xz for KITTI, xy otherwise.
Plane usual_plane(TrajectoryFormat format);

/// The axes of a plane.
struct PlaneAxes {
  Plane named = Plane::xy;  ///< xy, xz or yz: of `fit`, the one next to it
  double tilt_rad = 0.0;    ///< of `fit`: between its normal and that of the named plane
  /// From the axes of the world to forward, left and up of the plane. A rotation.
  Eigen::Matrix3d plane_from_world = Eigen::Matrix3d::Identity();
  /// From the axes of the body to its forward, left and up. A rotation.
  Eigen::Matrix3d level_from_body = Eigen::Matrix3d::Identity();
};

/// `fit` takes its axes and its upper side from the named plane next to it, or from `next_to`, that
/// of a trajectory to be compared with, if its normal is within 60 degrees of that one's. Throws
/// InputError where positions on a line leave the plane of least squares open.
PlaneAxes axes_of(Plane plane, std::span<const StampedSpatialPose> trajectory,
                  std::optional<Plane> next_to = std::nullopt);

/// How a body is mounted: the axis of it (±x, ±y, ±z after level_from_body) that points up on the
/// mean, and the one whose direction on the plane is its heading. That is x, so that the heading is
/// the yaw of yaw, pitch and roll, unless x is what points up: then it is z.
struct BodyAxes {
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX();
  Eigen::Vector3d mean_up = Eigen::Vector3d::UnitZ();  ///< the mean itself, not of unit length
};

BodyAxes body_axes(std::span<const StampedSpatialPose> trajectory, const PlaneAxes& axes);

/// What a projection leaves out.
struct ProjectionLoss {
  double height_rms_m = 0.0;  ///< about the mean height
  double height_max_m = 0.0;  ///< the largest such, without sign
  double roll_rms_rad = 0.0;
  double pitch_rms_rad = 0.0;
  /// Poses whose forward axis is within 10° of the vertical: their heading is next to open.
  std::size_t open_headings = 0;
  /// The named plane that would leave out far less height: where the heights are above a tenth of
  /// the extent on the plane (root mean squares about the mean), and those off another below a
  /// quarter of them.
  std::optional<Plane> better;
};

/// A trajectory on its plane: x forward, y left, headings counter-clockwise seen from above.
struct Projection {
  std::vector<StampedPose> trajectory;
  std::vector<double> heights_m;
  ProjectionLoss loss;
};

Projection project(std::span<const StampedSpatialPose> trajectory, const PlaneAxes& axes,
                   const BodyAxes& body);

/// Back in space, at height 0 and level, in forward, left and up.
std::vector<StampedSpatialPose> to_space(std::span<const StampedPose> trajectory);

}  // namespace fathom
