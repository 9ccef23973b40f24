#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/datasets/absolute_readings.hpp"
#include "fathom/datasets/earth_origin.hpp"

namespace fathom {

/// `compass0` of an image folder, as recorded.
struct FolderCompass {
  /// Of the compass, not of the body: counter-clockwise from the world's x axis, or clockwise from
  /// north.
  std::vector<MeasuredHeading> readings;
  bool is_from_north = false;
  double mount_yaw_rad = 0.0;           ///< of the compass in the body frame
  std::size_t left_out = 0;             ///< readings outside the survey's time
  std::vector<std::size_t> lines = {};  ///< of their rows, as read
  bool keeps_outliers = false;          ///< outliers: keep
};

/// A fix on Earth (WGS 84).
struct EarthFix {
  std::int64_t time_ns = 0;
  double latitude_deg = 0.0;
  double longitude_deg = 0.0;
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Identity();  ///< of north and east, m²
  std::size_t line = 0;                                      ///< of its row
};

/// `position0` of an image folder, as recorded: one of the two lists.
struct FolderFixes {
  std::filesystem::path csv;
  std::vector<PositionFix> in_world;
  std::vector<EarthFix> on_earth;
  Eigen::Vector2d lever_m = Eigen::Vector2d::Zero();  ///< of the antenna in the body frame
  std::vector<std::size_t> lines;                     ///< of their rows, as read
  bool keeps_outliers = false;                        ///< outliers: keep

  std::size_t size() const { return in_world.size() + on_earth.size(); }
};

/// What an image folder has of compass and positioning system.
struct FolderSensors {
  std::optional<FolderCompass> compass;
  std::optional<FolderFixes> fixes;
};

/// Both ends are of it.
struct TimeSpan {
  std::int64_t first_ns = 0;
  std::int64_t last_ns = 0;

  bool holds(std::int64_t time_ns) const { return time_ns >= first_ns && time_ns <= last_ns; }
};

/// Of `mav0`, whose pictures are those of `survey`, of all that were `recorded`. A fix outside the
/// latter is refused; what else is outside the survey is left out. Throws InputError with file and
/// line.
FolderSensors read_folder_sensors(const std::filesystem::path& mav0, const TimeSpan& survey,
                                  const TimeSpan& recorded);

/// Headings of the body and fixes in the world, whose x axis points where `origin` says; without
/// one to the north, if the compass says where that is. Throws InputError where fixes are on Earth
/// and the origin is not known, or further than 100 km from it, or Fathom is built without PROJ.
AbsoluteReadings in_world(const FolderSensors& sensors, const std::optional<EarthOrigin>& origin);

/// A place on Earth in the world of an origin: r along the geodesic from the origin, whose azimuth
/// is its direction, on the ellipsoid of WGS 84; m. Throws InputError without PROJ.
Eigen::Vector2d world_position(const EarthOrigin& origin, double latitude_deg,
                               double longitude_deg);

/// Writes `compass0` and `position0`, where there are such readings.
void write_folder_sensors(const AbsoluteReadings& readings, const std::filesystem::path& mav0);

}  // namespace fathom
