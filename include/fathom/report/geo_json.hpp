#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fathom/geometry/covariance.hpp"
#include "fathom/report/earth_frame.hpp"
#include "fathom/report/footprints.hpp"

namespace fathom {

/// A keyframe of an estimate.
struct TrackPoint {
  std::int64_t time_ns = 0;
  Pose pose;
  std::optional<Eigen::Matrix3d> covariance;  ///< of (x, y, θ), axes of the map
};

/// A registration between two keyframes, with the word for its fate.
struct TrackLoop {
  std::size_t from = 0;
  std::size_t to = 0;
  std::string fate;
};

// GeoJSON (RFC 7946): longitude, latitude in WGS 84, 9 decimals; what crosses the antimeridian is
// cut there. All throw InputError where EarthFrame::on_earth does.

/// A line through all keyframes, and a point each with its time, pose, heading on Earth and
/// standard deviations. Throws InputError without a keyframe.
std::string track_geojson(const EarthFrame& earth, std::span<const TrackPoint> track);

/// A line a registration, between its keyframes.
std::string loops_geojson(const EarthFrame& earth, std::span<const TrackPoint> track,
                          std::span<const TrackLoop> loops);

/// A polygon a footprint, with its overlaps.
std::string footprints_geojson(const EarthFrame& earth, std::span<const Footprint> footprints);

}  // namespace fathom
