#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <iomanip>
#include <sstream>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

namespace fathom::test {

/// What a command prints on standard output; empty where it cannot be run.
inline std::string printed_by(const std::string& command) {
  std::FILE* pipe = ::popen((command + " 2>/dev/null").c_str(), "r");
  if (pipe == nullptr) return {};
  std::string text;
  std::array<char, 4096> buffer{};
  while (const std::size_t count = std::fread(buffer.data(), 1, buffer.size(), pipe)) {
    text.append(buffer.data(), count);
  }
  ::pclose(pipe);
  return text;
}

/// GDAL's programs, an independent reader of maps: Debian's gdal-bin.
inline bool has_gdal() {
  return printed_by("gdalinfo --version").starts_with("GDAL");
}
inline constexpr const char* kNoGdal =
    "gdalinfo is not installed ('scripts/setup.sh import' installs it)";

/// What gdalinfo says of a file.
inline nlohmann::json gdal_info(const std::filesystem::path& file) {
  return nlohmann::json::parse(printed_by("gdalinfo -json " + file.string()));
}

/// Easting and northing of the middle of a (column, row), by the geotransform that gdalinfo read.
inline Eigen::Vector2d gdal_place(const nlohmann::json& info, double column, double row) {
  const auto t = info.at("geoTransform").get<std::array<double, 6>>();
  return {t[0] + (column + 0.5) * t[1] + (row + 0.5) * t[2],
          t[3] + (column + 0.5) * t[4] + (row + 0.5) * t[5]};
}

/// Where points of a map lie in the plane of a projection: gdaltransform takes them from an
/// azimuthal equidistant plane about the start. x ahead, y to port; heading clockwise.
inline std::vector<Eigen::Vector2d> gdal_projected(double latitude_deg, double longitude_deg,
                                                   double heading_deg,
                                                   const std::vector<Eigen::Vector2d>& map,
                                                   int epsg) {
  const double heading = heading_deg * 3.14159265358979323846 / 180.0;
  std::ostringstream command;
  command << std::setprecision(17) << "printf -- '";
  for (const Eigen::Vector2d& point : map) {
    const double east = point.x() * std::sin(heading) - point.y() * std::cos(heading);
    const double north = point.x() * std::cos(heading) + point.y() * std::sin(heading);
    command << east << ' ' << north << "\\n";
  }
  command << "' | gdaltransform -s_srs '+proj=aeqd +lat_0=" << latitude_deg
          << " +lon_0=" << longitude_deg << " +ellps=WGS84 +type=crs' -t_srs EPSG:" << epsg;
  std::istringstream out(printed_by(command.str()));
  std::vector<Eigen::Vector2d> places(map.size(), Eigen::Vector2d::Constant(-1.0));
  for (Eigen::Vector2d& place : places) {
    double height = 0.0;
    out >> place.x() >> place.y() >> height;
  }
  return places;
}

}  // namespace fathom::test
