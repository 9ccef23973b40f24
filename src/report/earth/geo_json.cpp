#include "fathom/report/geo_json.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "fathom/core/input_error.hpp"
#include "meridian_cut.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

// 1e-9° is a tenth of a millimetre.
double rounded(double degrees) {
  return std::round(degrees * 1e9) / 1e9;
}

double share(double value) {
  return std::round(value * 1e6) / 1e6;
}

Json position(const LonLat& place) {
  return {rounded(place.x()), rounded(place.y())};
}

Json positions(const std::vector<LonLat>& line) {
  Json list = Json::array();
  for (const LonLat& place : line) list.push_back(position(place));
  return list;
}

LonLat lon_lat(const EarthPose& pose) {
  return {pose.longitude_deg, pose.latitude_deg};
}

/// A FeatureCollection as text, a line a feature: a long survey has more than memory has room for
/// as objects.
class FeatureCollection {
 public:
  void add(Json geometry, Json properties) {
    const Json feature{{"type", "Feature"},
                       {"geometry", std::move(geometry)},
                       {"properties", std::move(properties)}};
    text_ += (text_.empty() ? "\n" : ",\n") + feature.dump();
  }
  std::string text() const {
    return "{\"type\": \"FeatureCollection\", \"features\": [" + text_ + "\n]}\n";
  }

 private:
  std::string text_;
};

Json line_geometry(const std::vector<LonLat>& line) {
  const auto parts = cut_line(line);
  if (parts.size() == 1) return {{"type", "LineString"}, {"coordinates", positions(parts[0])}};
  Json coordinates = Json::array();
  for (const auto& part : parts) coordinates.push_back(positions(part));
  return {{"type", "MultiLineString"}, {"coordinates", coordinates}};
}

Json polygon_geometry(const std::vector<LonLat>& ring) {
  const auto parts = cut_polygon(ring);
  Json coordinates = Json::array();
  for (const auto& part : parts) coordinates.push_back(Json::array({positions(part)}));
  if (parts.size() == 1) return {{"type", "Polygon"}, {"coordinates", coordinates[0]}};
  return {{"type", "MultiPolygon"}, {"coordinates", coordinates}};
}

// 15 and not 15.000000000000002.
double seconds(std::int64_t time_ns) {
  return static_cast<double>(time_ns) / 1e9;
}

Json keyframe_properties(std::size_t k, const TrackPoint& point, const EarthPose& earth) {
  Json properties{{"keyframe", k},
                  {"time_s", seconds(point.time_ns)},
                  {"x_m", point.pose.x},
                  {"y_m", point.pose.y},
                  {"heading_deg", rounded(earth.heading_deg)}};
  if (!point.covariance || !point.covariance->allFinite()) return properties;
  const auto sigma = [&](int i) { return std::sqrt(std::max(0.0, (*point.covariance)(i, i))); };
  properties["sigma_x_m"] = sigma(0);
  properties["sigma_y_m"] = sigma(1);
  properties["sigma_heading_deg"] = sigma(2) * 180.0 / std::numbers::pi;
  return properties;
}

}  // namespace

std::string track_geojson(const EarthFrame& earth, std::span<const TrackPoint> track) {
  if (track.empty()) throw InputError("a track needs at least one keyframe");
  std::vector<EarthPose> poses;
  std::vector<LonLat> line;
  for (const TrackPoint& point : track) {
    poses.push_back(earth.on_earth(point.pose));
    line.push_back(lon_lat(poses.back()));
  }
  FeatureCollection features;
  if (line.size() > 1) {
    features.add(line_geometry(line), {{"keyframes", track.size()},
                                       {"begin_s", seconds(track.front().time_ns)},
                                       {"end_s", seconds(track.back().time_ns)}});
  }
  for (std::size_t k = 0; k < track.size(); ++k) {
    features.add({{"type", "Point"}, {"coordinates", position(line[k])}},
                 keyframe_properties(k, track[k], poses[k]));
  }
  return features.text();
}

std::string loops_geojson(const EarthFrame& earth, std::span<const TrackPoint> track,
                          std::span<const TrackLoop> loops) {
  FeatureCollection features;
  for (const TrackLoop& loop : loops) {
    const std::vector<LonLat> ends{lon_lat(earth.on_earth(track[loop.from].pose)),
                                   lon_lat(earth.on_earth(track[loop.to].pose))};
    features.add(line_geometry(ends), {{"from", loop.from}, {"to", loop.to}, {"fate", loop.fate}});
  }
  return features.text();
}

std::string footprints_geojson(const EarthFrame& earth, std::span<const Footprint> footprints) {
  FeatureCollection features;
  for (const Footprint& one : footprints) {
    std::vector<LonLat> ring;
    for (const Eigen::Vector2d& corner : one.corners) {
      ring.push_back(lon_lat(earth.on_earth({corner.x(), corner.y(), 0.0})));
    }
    Json properties{{"keyframe", one.keyframe}, {"time_s", seconds(one.time_ns)}};
    if (one.overlap_previous) properties["overlap_previous"] = share(*one.overlap_previous);
    properties["overlap_other_pass"] = share(one.overlap_other_pass);
    if (one.other_pass) properties["other_pass"] = *one.other_pass;
    features.add(polygon_geometry(ring), std::move(properties));
  }
  return features.text();
}

}  // namespace fathom
