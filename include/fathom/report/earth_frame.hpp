#pragma once

#include <memory>
#include <string>

#include <Eigen/Core>

#include "fathom/datasets/earth_origin.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// A pose of the body on Earth (WGS 84).
struct EarthPose {
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;  ///< from −180 to 180
  double heading_deg = 0.0;    ///< of the body's x axis, clockwise from true north, 0 to 360
};

/// A pose of the body in the plane of a map projection, whose x goes to grid north and y to grid
/// west, from keyframe 0 on: the projection has easting = easting_0 − y, northing = northing_0 + x.
struct GridPose {
  Pose pose;
  double scale = 1.0;  ///< metres of the plane a metre of the floor, about this place
};

/// Where a map lies on Earth. Its frame is the body's at keyframe 0: a point of the map at distance
/// r lies r along the geodesic that leaves the origin at the point's azimuth, on the ellipsoid of
/// WGS 84 at height 0. The projection is UTM in the zone of the origin, beyond 84° north and 80°
/// south UPS. Not for several threads at once.
class EarthFrame {
 public:
  /// Throws InputError that says how to have it where this build lacks the feature "geotiff".
  explicit EarthFrame(const EarthOrigin& origin);
  ~EarthFrame();
  EarthFrame(EarthFrame&&) noexcept;
  EarthFrame& operator=(EarthFrame&&) noexcept;

  /// Throws InputError on a pose that is not finite or over 100 km from the origin, where a map of
  /// a flat floor means nothing.
  EarthPose on_earth(const Pose& map) const;
  /// Likewise.
  GridPose on_grid(const Pose& map) const;

  /// Easting and northing of a point of the projection's plane, m.
  Eigen::Vector2d easting_northing(const Eigen::Vector2d& grid) const;

  int epsg() const;                 ///< of the projection: 32633
  const std::string& name() const;  ///< "WGS 84 / UTM zone 33N"

 private:
  struct Projection;
  std::unique_ptr<Projection> projection_;
};

}  // namespace fathom
