#include "fathom/report/earth_frame.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.hpp"
#include "support/requirements.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::HasSubstr;

constexpr double kDegrees = 180.0 / std::numbers::pi;

/// A point of the map, its easting and northing, latitude and longitude.
struct Point {
  double x, y, easting, northing, latitude_deg, longitude_deg;
};

struct Case {
  EarthOrigin origin;
  int epsg;
  std::vector<Point> points;
};

// By GDAL 3.6.2 with PROJ 9.1.1, of (e, n) = (x sin h - y cos h, x cos h + y sin h):
//   echo e n | gdaltransform -s_srs '+proj=aeqd +lat_0=… +lon_0=… +ellps=WGS84' -t_srs EPSG:…
// and with -t_srs '+proj=longlat +ellps=WGS84'. The azimuthal equidistant projection keeps distance
// and azimuth from its middle on the ellipsoid.
const std::vector<Case>& cases() {
  static const std::vector<Case> all{
      {{39.5, 2.5, 0},
       32631,
       {{0, 0, 457010.3877, 4372383.8236, 39.5000000000, 2.5000000000},
        {1000, 0, 457015.9371, 4373383.4310, 39.5090069702, 2.5000000000},
        {0, 1000, 456010.7799, 4372389.3724, 39.4999994187, 2.4883739072},
        {-750, -420, 457426.0614, 4371631.7879, 39.4932446607, 2.5048824864}}},
      {{39.5, 2.5, 90},
       32631,
       {{0, 0, 457010.3877, 4372383.8236, 39.5000000000, 2.5000000000},
        {1000, 0, 458009.9946, 4372378.2748, 39.4999994187, 2.5116260928},
        {0, 1000, 457015.9371, 4373383.4310, 39.5090069702, 2.5000000000},
        {-750, -420, 456258.3515, 4371968.1498, 39.4962167414, 2.4912809030}}},
      {{39.5, 2.5, 213},
       32631,
       {{0, 0, 457010.3877, 4372383.8236, 39.5000000000, 2.5000000000},
        {1000, 0, 456461.3092, 4371548.5039, 39.4924459360, 2.4936686613},
        {0, 1000, 457845.7067, 4371834.7453, 39.4950940378, 2.5097497765},
        {-750, -420, 457071.3632, 4373240.9260, 39.5077257396, 2.5006538964}}},
      {{-33.86, 151.2, 213},
       32756,
       {{0, 0, 333491.2299, 6251909.2060, -33.8600000000, 151.2000000000},
        {1000, 0, 332961.3887, 6251061.1765, -33.8675609045, 151.1941137868},
        {0, 1000, 334339.2567, 6251379.3658, -33.8649098679, 151.2090636934},
        {-750, -420, 333532.4414, 6252767.7603, -33.8522669211, 151.2006076827}}},
      {{0.0, 5.9999, 45},
       32631,
       {{0, 0, 833967.4140, 0.0000, 0.0000000000, 5.9999000000},
        {1000, 0, 834675.2145, 707.8046, 0.0063948579, 6.0062520483},
        {0, 1000, 833259.6136, 707.7963, 0.0063948579, 5.9935479517},
        {-750, -420, 833733.8373, -828.1249, -0.0074819837, 5.9978038241}}},
      {{-10.0, 179.99999, 90},
       32760,
       {{0, 0, 828927.6387, 8893091.1557, -10.0000000000, 179.9999900000},
        {1000, 0, 829928.5404, 8893082.0469, -9.9999998750, -179.9908891883},
        {0, 1000, 828936.7434, 8894092.0534, -9.9909590410, 179.9999900000},
        {-750, -420, 828173.1414, 8892677.6129, -10.0037971310, 179.9931493118}}},
      {{65.0, -180.0, 300},
       32601,
       {{0, 0, 358571.5703, 7211811.3076, 65.0000000000, -180.0000000000},
        {1000, 0, 357730.3720, 7212351.7501, 65.0044834728, 179.9816394097},
        {0, 1000, 358031.1301, 7210970.1084, 64.9922320614, 179.9894043620},
        {-750, -420, 359429.4524, 7211759.2801, 64.9998978122, -179.9817804747}}},
      {{85.5, 30.0, 213},
       5041,
       {{0, 0, 2249926.8817, 1567113.9427, 85.5000000000, 30.0000000000},
        {1000, 0, 2249874.7777, 1566119.7701, 85.4924882535, 29.9379528322},
        {0, 1000, 2250921.0536, 1567061.8429, 85.4951172791, 30.0955999272},
        {-750, -420, 2249548.4078, 1567881.4511, 85.5076799257, 30.0064284058}}},
      {{-88.0, -120.0, 90},
       5042,
       {{0, 0, 1807682.3717, 1888965.3655, -88.0000000000, -120.0000000000},
        {1000, 0, 1807185.2215, 1889826.4577, -87.9999799687, -119.7434630334},
        {0, 1000, 1806821.2790, 1888468.2134, -87.9910468552, -120.0000000000},
        {-750, -420, 1808416.8937, 1888528.3515, -88.0037490317, -120.1927655643}}}};
  return all;
}

class EarthFrameTest : public ::testing::Test {
 protected:
  void SetUp() override { FATHOM_REQUIRE_FEATURE("geotiff"); }
};

TEST_F(EarthFrameTest, PointsLieWhereGdalHasThem) {
  for (const Case& one : cases()) {
    const EarthFrame earth(one.origin);
    EXPECT_EQ(earth.epsg(), one.epsg);
    for (const Point& point : one.points) {
      SCOPED_TRACE(testing::Message() << one.epsg << " at " << point.x << ", " << point.y);
      const Pose pose{point.x, point.y, 0.3};
      const EarthPose on_earth = earth.on_earth(pose);
      EXPECT_NEAR(on_earth.latitude_deg, point.latitude_deg, 1e-9);
      EXPECT_NEAR(std::remainder(on_earth.longitude_deg - point.longitude_deg, 360.0), 0.0, 2e-9);
      const GridPose grid = earth.on_grid(pose);
      const Eigen::Vector2d place = earth.easting_northing(grid.pose.position());
      EXPECT_NEAR(place.x(), point.easting, 1e-4);
      EXPECT_NEAR(place.y(), point.northing, 1e-4);
    }
  }
}

// The heading and the scale of the grid, from where the points ahead and behind come to lie.
TEST_F(EarthFrameTest, HeadingAndScaleAreThoseOfAStepAhead) {
  for (const Case& one : cases()) {
    const EarthFrame earth(one.origin);
    for (const Point& point : one.points) {
      SCOPED_TRACE(testing::Message() << one.epsg << " at " << point.x << ", " << point.y);
      const Pose pose{point.x, point.y, 0.7};
      const Pose ahead = compose(pose, Pose{0.5, 0.0, 0.0});
      const Pose behind = compose(pose, Pose{-0.5, 0.0, 0.0});
      const GridPose grid = earth.on_grid(pose);
      const Eigen::Vector2d step =
          earth.on_grid(ahead).pose.position() - earth.on_grid(behind).pose.position();
      EXPECT_NEAR(wrap_angle(std::atan2(step.y(), step.x()) - grid.pose.theta), 0.0, 1e-7);
      EXPECT_NEAR(step.norm(), grid.scale, 1e-7);
    }
  }
}

TEST_F(EarthFrameTest, HeadingIsClockwiseFromTrueNorth) {
  const EarthFrame earth({47.0, 8.0, 213.0});
  EXPECT_NEAR(earth.on_earth({0, 0, 0}).heading_deg, 213.0, 1e-9);
  // A turn to port is counter-clockwise.
  EXPECT_NEAR(earth.on_earth({0, 0, 10.0 / kDegrees}).heading_deg, 203.0, 1e-9);
  EXPECT_NEAR(EarthFrame({47.0, 8.0, -90.0}).on_earth({0, 0, 0}).heading_deg, 270.0, 1e-9);
  // 10 km east the meridian has turned by the difference of longitudes times the sine of latitude.
  const EarthPose east = EarthFrame({60.0, 8.0, 90.0}).on_earth({10e3, 0, 0});
  EXPECT_NEAR(east.heading_deg - 90.0, (east.longitude_deg - 8.0) * std::sin(60.0 / kDegrees),
              1e-4);
}

TEST_F(EarthFrameTest, ZonesFollowLongitudeAndHemisphere) {
  const auto epsg = [](double latitude, double longitude) {
    return EarthFrame({latitude, longitude, 0.0}).epsg();
  };
  EXPECT_EQ(epsg(0.0, -180.0), 32601);
  EXPECT_EQ(epsg(0.0, 180.0), 32601);
  EXPECT_EQ(epsg(-1e-9, 179.999), 32760);
  EXPECT_EQ(epsg(50.0, -1e-9), 32630);
  EXPECT_EQ(epsg(50.0, 0.0), 32631);
  EXPECT_EQ(epsg(83.99, 3.0), 32631);
  EXPECT_EQ(epsg(84.0, 3.0), 5041);
  EXPECT_EQ(epsg(-80.0, 3.0), 32731);
  EXPECT_EQ(epsg(-80.01, 3.0), 5042);
  EXPECT_EQ(EarthFrame({-33.0, 151.0, 0.0}).name(), "WGS 84 / UTM zone 56S");
}

TEST_F(EarthFrameTest, AtThePoleItself) {
  for (const double latitude : {90.0, -90.0}) {
    const EarthFrame earth({latitude, 0.0, 0.0});
    const GridPose grid = earth.on_grid({30.0, 40.0, 0.0});
    EXPECT_NEAR(grid.pose.position().norm(), 0.994 * 50.0, 1e-6);
    EXPECT_NEAR(grid.scale, 0.994, 1e-9);
  }
}

TEST_F(EarthFrameTest, RefusesWhatIsFarOrNoNumber) {
  const EarthFrame earth({47.0, 8.0, 0.0});
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  for (const Pose& pose :
       {Pose{1e6, 0, 0}, Pose{kNaN, 0, 0}, Pose{0, 0, kNaN}, Pose{1e300, 1e300, 0}}) {
    EXPECT_THAT(input_error_of([&] { earth.on_earth(pose); }), HasSubstr("ends at 100 km"));
    EXPECT_THAT(input_error_of([&] { earth.on_grid(pose); }), HasSubstr("ends at 100 km"));
  }
}

TEST(EarthFrame, WithoutPROJTheMessageSaysHowToHaveIt) {
  if (feature("geotiff").is_built) GTEST_SKIP() << "does not apply: built with libgeotiff";
  EXPECT_THAT(input_error_of([] {
                EarthFrame({47.0, 8.0, 0.0});
              }),
              HasSubstr("'scripts/build.sh import' installs"));
}

}  // namespace
}  // namespace fathom
