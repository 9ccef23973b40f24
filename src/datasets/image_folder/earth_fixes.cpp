#include <cmath>
#include <numbers>

#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/folder_sensors.hpp"
#include "fathom/geometry/pose.hpp"

#ifdef FATHOM_PROJ
#include <geodesic.h>
#endif

namespace fathom {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr double kFurthest_m = 100e3;

// From (north, east) to the axes of the world.
Eigen::Matrix2d axes_of(const EarthOrigin& origin) {
  const double azimuth_rad = origin.heading_deg * kRadians;
  Eigen::Matrix2d R;
  R << std::cos(azimuth_rad), std::sin(azimuth_rad), std::sin(azimuth_rad), -std::cos(azimuth_rad);
  return R;
}

PositionFix fix_in_world(const EarthFix& fix, const EarthOrigin& origin, const std::string& file) {
  const Eigen::Matrix2d R = axes_of(origin);
  const Eigen::Matrix2d C = R * fix.covariance * R.transpose();
  const PositionFix in_world{fix.time_ns,
                             world_position(origin, fix.latitude_deg, fix.longitude_deg),
                             0.5 * (C + C.transpose())};
  const double distance_m = in_world.position_m.norm();
  if (distance_m <= kFurthest_m) return in_world;
  throw InputError(file, fix.line,
                   "a fix is " + short_number(1e-3 * distance_m) +
                       " km from dataset.origin; expected at most 100 km");
}

}  // namespace

#ifdef FATHOM_PROJ
Eigen::Vector2d world_position(const EarthOrigin& origin, double latitude_deg,
                               double longitude_deg) {
  geod_geodesic ellipsoid{};
  geod_init(&ellipsoid, 6378137.0, 1.0 / 298.257223563);
  double distance_m = 0.0;
  double azimuth_deg = 0.0;
  double arrival_deg = 0.0;
  geod_inverse(&ellipsoid, origin.latitude_deg, origin.longitude_deg, latitude_deg, longitude_deg,
               &distance_m, &azimuth_deg, &arrival_deg);
  // Azimuths go clockwise; directions counter-clockwise from the x axis.
  const double direction_rad = (origin.heading_deg - azimuth_deg) * kRadians;
  return distance_m * Eigen::Vector2d(std::cos(direction_rad), std::sin(direction_rad));
}
#else
Eigen::Vector2d world_position(const EarthOrigin& /*origin*/, double /*latitude_deg*/,
                               double /*longitude_deg*/) {
  throw InputError("fixes in latitude and longitude: " + refusal_without("proj"));
}
#endif

AbsoluteReadings in_world(const FolderSensors& sensors, const std::optional<EarthOrigin>& origin) {
  AbsoluteReadings readings;
  if (sensors.compass) {
    const FolderCompass& compass = *sensors.compass;
    const double x_axis_rad = origin ? origin->heading_deg * kRadians : 0.0;
    for (MeasuredHeading reading : compass.readings) {
      const double heading_rad =
          compass.is_from_north ? x_axis_rad - reading.heading_rad : reading.heading_rad;
      reading.heading_rad = wrap_angle(heading_rad - compass.mount_yaw_rad);
      readings.headings.push_back(reading);
    }
  }
  if (!sensors.fixes) return readings;
  const FolderFixes& fixes = *sensors.fixes;
  readings.lever_m = fixes.lever_m;
  readings.fixes = fixes.in_world;
  for (const EarthFix& fix : fixes.on_earth) {
    if (!origin) {
      throw InputError(fixes.csv.string(), fix.line,
                       "fixes in latitude and longitude, and nothing says where the map lies on "
                       "Earth; expected dataset.origin: {latitude: , longitude: , heading: }");
    }
    readings.fixes.push_back(fix_in_world(fix, *origin, fixes.csv.string()));
  }
  return readings;
}

}  // namespace fathom
