#pragma once

#include <vector>

#include <Eigen/Core>

namespace fathom {

/// Longitude and latitude, degrees, longitude from −180 to 180.
using LonLat = Eigen::Vector2d;

/// A line cut where it crosses the antimeridian: RFC 7946 (3.1.9) asks for it, as a program would
/// else draw it around the Earth. Each step is taken the short way.
std::vector<std::vector<LonLat>> cut_line(const std::vector<LonLat>& line);

/// Likewise a convex polygon far from the poles, in either direction, without its first corner
/// repeated. The rings are closed and counter-clockwise, as the RFC has outer rings (3.1.6).
std::vector<std::vector<LonLat>> cut_polygon(const std::vector<LonLat>& ring);

}  // namespace fathom
