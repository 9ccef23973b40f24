#include "fathom/report/earth_frame.hpp"

#include <cmath>
#include <numbers>

#include "fathom/core/features.hpp"
#include "fathom/core/input_error.hpp"

#ifdef FATHOM_GEOTIFF
#include <geodesic.h>
#include <proj.h>
#endif

namespace fathom {

#ifdef FATHOM_GEOTIFF
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr double kFurthest_m = 100e3;

struct ProjectedSystem {
  int epsg = 0;
  std::string name;
  std::string definition;
};

ProjectedSystem polar(bool north) {
  return {north ? 5041 : 5042, north ? "WGS 84 / UPS North (E,N)" : "WGS 84 / UPS South (E,N)",
          std::string("+proj=stere +lat_0=") + (north ? "90" : "-90") +
              " +k=0.994 +x_0=2000000 +y_0=2000000 +ellps=WGS84"};
}

ProjectedSystem system_of(const EarthOrigin& origin) {
  if (origin.latitude_deg >= 84.0 || origin.latitude_deg < -80.0) {
    return polar(origin.latitude_deg > 0.0);
  }
  const bool north = origin.latitude_deg >= 0.0;
  // 180° is −180°.
  const int zone = static_cast<int>(std::floor((origin.longitude_deg + 180.0) / 6.0)) % 60 + 1;
  return {(north ? 32600 : 32700) + zone,
          "WGS 84 / UTM zone " + std::to_string(zone) + (north ? "N" : "S"),
          "+proj=utm +zone=" + std::to_string(zone) + (north ? "" : " +south") + " +ellps=WGS84"};
}

struct DestroyContext {
  void operator()(PJ_CONTEXT* context) const { proj_context_destroy(context); }
};
struct DestroyProjection {
  void operator()(PJ* projection) const { proj_destroy(projection); }
};

}  // namespace

struct EarthFrame::Projection {
  explicit Projection(const EarthOrigin& start)
      : origin(start),
        system(system_of(start)),
        context(proj_context_create()),
        forward(proj_create(context.get(), system.definition.c_str())) {
    geod_init(&ellipsoid, 6378137.0, 1.0 / 298.257223563);
    if (!forward) throw InputError("PROJ does not know " + system.definition);
    origin_en = projected(origin.latitude_deg, origin.longitude_deg);
  }

  static PJ_COORD radians(double latitude_deg, double longitude_deg) {
    return proj_coord(longitude_deg / kDegrees, latitude_deg / kDegrees, 0.0, 0.0);
  }

  Eigen::Vector2d projected(double latitude_deg, double longitude_deg) const {
    const PJ_COORD place = proj_trans(forward.get(), PJ_FWD, radians(latitude_deg, longitude_deg));
    return {place.xy.x, place.xy.y};
  }

  EarthOrigin origin;
  ProjectedSystem system;
  std::unique_ptr<PJ_CONTEXT, DestroyContext> context;
  std::unique_ptr<PJ, DestroyProjection> forward;
  geod_geodesic ellipsoid{};
  Eigen::Vector2d origin_en;  ///< easting and northing of keyframe 0
};

EarthFrame::EarthFrame(const EarthOrigin& origin)
    : projection_(std::make_unique<Projection>(origin)) {}

EarthPose EarthFrame::on_earth(const Pose& map) const {
  const double distance_m = map.position().norm();
  if (!std::isfinite(distance_m) || !std::isfinite(map.theta) || distance_m > kFurthest_m) {
    throw InputError("a map on Earth ends at 100 km from its start, and a pose is beyond");
  }
  // Counter-clockwise from the x axis; azimuths go clockwise.
  const double direction_deg = std::atan2(map.y, map.x) * kDegrees;
  const EarthOrigin& origin = projection_->origin;
  EarthPose pose;
  double azimuth_deg = 0.0;
  geod_direct(&projection_->ellipsoid, origin.latitude_deg, origin.longitude_deg,
              origin.heading_deg - direction_deg, distance_m, &pose.latitude_deg,
              &pose.longitude_deg, &azimuth_deg);
  // The geodesic arrives at another azimuth than it left: meridians converge.
  const double heading_deg = azimuth_deg + direction_deg - map.theta * kDegrees;
  pose.heading_deg = heading_deg - 360.0 * std::floor(heading_deg / 360.0);
  return pose;
}

GridPose EarthFrame::on_grid(const Pose& map) const {
  const EarthPose earth = on_earth(map);
  const Eigen::Vector2d from_origin =
      projection_->projected(earth.latitude_deg, earth.longitude_deg) - projection_->origin_en;
  const PJ_FACTORS factors = proj_factors(
      projection_->forward.get(), Projection::radians(earth.latitude_deg, earth.longitude_deg));
  const double grid_azimuth = earth.heading_deg / kDegrees - factors.meridian_convergence;
  return {Pose{from_origin.y(), -from_origin.x(), wrap_angle(-grid_azimuth)},
          factors.meridional_scale};
}

Eigen::Vector2d EarthFrame::easting_northing(const Eigen::Vector2d& grid) const {
  return projection_->origin_en + Eigen::Vector2d(-grid.y(), grid.x());
}

int EarthFrame::epsg() const {
  return projection_->system.epsg;
}

const std::string& EarthFrame::name() const {
  return projection_->system.name;
}
#else
struct EarthFrame::Projection {
  std::string name;
};

EarthFrame::EarthFrame(const EarthOrigin& /*origin*/) {
  throw InputError("maps on Earth: " + refusal_without("geotiff"));
}

EarthPose EarthFrame::on_earth(const Pose& /*map*/) const {
  return {};
}

GridPose EarthFrame::on_grid(const Pose& /*map*/) const {
  return {};
}

Eigen::Vector2d EarthFrame::easting_northing(const Eigen::Vector2d& grid) const {
  return grid;
}

int EarthFrame::epsg() const {
  return 0;
}

const std::string& EarthFrame::name() const {
  return projection_->name;
}
#endif

EarthFrame::~EarthFrame() = default;
EarthFrame::EarthFrame(EarthFrame&&) noexcept = default;
EarthFrame& EarthFrame::operator=(EarthFrame&&) noexcept = default;

}  // namespace fathom
