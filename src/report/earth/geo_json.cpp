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

Json feature(Json geometry, Json properties) {
  return {{"type", "Feature"},
          {"geometry", std::move(geometry)},
          {"properties", std::move(properties)}};
}

Json collection(Json features) {
  return {{"type", "FeatureCollection"}, {"features", std::move(features)}};
}

// A feature a line: files of long surveys are read by people, too.
std::string text_of(const Json& collection) {
  std::string text = "{\"type\": \"FeatureCollection\", \"features\": [";
  const char* separator = "\n";
  for (const Json& one : collection["features"]) {
    text += separator + one.dump();
    separator = ",\n";
  }
  return text + "\n]}\n";
}

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

double seconds(std::int64_t time_ns) {
  return 1e-9 * static_cast<double>(time_ns);
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
  std::vector<LonLat> line;
  Json points = Json::array();
  for (std::size_t k = 0; k < track.size(); ++k) {
    const EarthPose pose = earth.on_earth(track[k].pose);
    line.push_back(lon_lat(pose));
    points.push_back(feature({{"type", "Point"}, {"coordinates", position(line.back())}},
                             keyframe_properties(k, track[k], pose)));
  }
  Json features = Json::array();
  if (line.size() > 1) {
    features.push_back(feature(line_geometry(line), {{"keyframes", track.size()},
                                                     {"begin_s", seconds(track.front().time_ns)},
                                                     {"end_s", seconds(track.back().time_ns)}}));
  }
  for (Json& point : points) features.push_back(std::move(point));
  return text_of(collection(std::move(features)));
}

std::string loops_geojson(const EarthFrame& earth, std::span<const TrackPoint> track,
                          std::span<const TrackLoop> loops) {
  Json features = Json::array();
  for (const TrackLoop& loop : loops) {
    const std::vector<LonLat> ends{lon_lat(earth.on_earth(track[loop.from].pose)),
                                   lon_lat(earth.on_earth(track[loop.to].pose))};
    features.push_back(
        feature(line_geometry(ends), {{"from", loop.from}, {"to", loop.to}, {"fate", loop.fate}}));
  }
  return text_of(collection(std::move(features)));
}

std::string footprints_geojson(const EarthFrame& earth, std::span<const Footprint> footprints) {
  Json features = Json::array();
  for (const Footprint& one : footprints) {
    std::vector<LonLat> ring;
    for (const Eigen::Vector2d& corner : one.corners) {
      ring.push_back(lon_lat(earth.on_earth({corner.x(), corner.y(), 0.0})));
    }
    Json properties{{"keyframe", one.keyframe}, {"time_s", seconds(one.time_ns)}};
    if (one.overlap_previous) properties["overlap_previous"] = share(*one.overlap_previous);
    properties["overlap_other_pass"] = share(one.overlap_other_pass);
    if (one.other_pass) properties["other_pass"] = *one.other_pass;
    features.push_back(feature(polygon_geometry(ring), std::move(properties)));
  }
  return text_of(collection(std::move(features)));
}

}  // namespace fathom
