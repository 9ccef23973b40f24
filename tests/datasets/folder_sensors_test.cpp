// compass0 and position0 of an image folder.

#include "fathom/datasets/folder_sensors.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/sensor_summary.hpp"
#include "folder_fixture.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"
#include "support/requirements.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using test::input_error_of;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const char* const kCompass = "compass0/data.csv";
const char* const kCompassYaml = "compass0/sensor.yaml";
const char* const kFixes = "position0/data.csv";
const char* const kFixesYaml = "position0/sensor.yaml";
const std::string kWorld = "#timestamp [ns],x [m],y [m],var_x [m^2],cov_xy [m^2],var_y [m^2]\n";
const std::string kEarth =
    "#timestamp [ns],latitude [deg],longitude [deg],var_north [m^2],cov_north_east [m^2],"
    "var_east [m^2]\n";

TEST(FolderSensors, AreReadAsTheyAre) {
  FolderFixture fixture;
  fixture.files[kCompass] = "#t,heading,sigma\n-1,0,1\n0,6.2,0.02\n1500,-1.5,0.03\n2001,0,1\n";
  fixture.files[kFixes] = kWorld + "700,1.5,-2,4,0.5,9\n";
  fixture.files[kFixesYaml] = "sensor_type: position\nmounting: {x: 0.3, y: -0.1}\n";
  const ImageFolder folder(fixture.write());
  const AbsoluteReadings readings = in_world(folder.sensors(), std::nullopt);
  ASSERT_EQ(readings.headings.size(), 2u);
  EXPECT_NEAR(readings.headings[0].heading_rad, 6.2 - 2 * std::numbers::pi, 1e-15);
  EXPECT_EQ(readings.headings[1].sigma_rad, 0.03);
  EXPECT_EQ(folder.sensors().compass->left_out, 2u);
  ASSERT_EQ(readings.fixes.size(), 1u);
  EXPECT_EQ(readings.fixes[0].time_ns, 700);
  EXPECT_EQ(readings.fixes[0].position_m, Eigen::Vector2d(1.5, -2));
  EXPECT_EQ(readings.fixes[0].covariance(0, 1), 0.5);
  EXPECT_EQ(readings.fixes[0].covariance(1, 1), 9);
  EXPECT_EQ(readings.lever_m, Eigen::Vector2d(0.3, -0.1));
}

// A clock that is put right leaves pictures out at one end, and with them the fixes there.
TEST(FolderSensors, FixesOfPicturesThatAreLeftOutAreLeftOut) {
  FolderFixture fixture;
  fixture.files["odometry0/sensor.yaml"] = "time_offset_s: 5.0e-7\n";
  fixture.files[kFixes] = kWorld + "100,1,2,4,0,4\n1500,3,4,4,0,4\n";
  const ImageFolder folder(fixture.write());
  EXPECT_EQ(folder.size(), 2u);
  ASSERT_EQ(folder.sensors().fixes->in_world.size(), 1u);
  EXPECT_EQ(folder.sensors().fixes->in_world[0].time_ns, 1500);
  fixture.files[kFixes] += "2001,3,4,4,0,4\n";
  EXPECT_THAT(input_error_of([&] { ImageFolder again(fixture.write()); }),
              HasSubstr("outside the time of the pictures, 0 to 2000 ns"));
}

TEST(FolderSensors, GroundTruthHasAClockToo) {
  FolderFixture fixture;
  fixture.files["state_groundtruth_estimate0/sensor.yaml"] = "time_offset_s: 1.0e-6\n";
  fixture.files["state_groundtruth_estimate0/data.csv"] =
      "#t,px,py,pz,qw,qx,qy,qz\n-1000,7,0,9,1,0,0,0\n0,8,0,9,1,0,0,0\n1000,9,2,9,1,0,0,0\n";
  const ImageFolder folder(fixture.write());
  EXPECT_TRUE(folder.has_ground_truth());
  EXPECT_EQ(folder.info(0).ground_truth->x, 7.0);
  EXPECT_EQ(folder.info(2).ground_truth->x, 9.0);
  EXPECT_THAT(folder.remarks(), IsEmpty());
}

// A compass turned to port by 0.2 rad on the body. East is a quarter turn clockwise from north.
TEST(FolderSensors, HeadingsFromNorthBecomeThoseOfTheWorld) {
  FolderFixture fixture;
  fixture.files[kCompass] = "0,1.5707963267948966,0.02\n";
  fixture.files[kCompassYaml] = "convention: clockwise_from_north\nmounting: {yaw: 0.2}\n";
  const ImageFolder folder(fixture.write());
  // World x to the north: east is at −90°.
  EXPECT_NEAR(in_world(folder.sensors(), std::nullopt).headings[0].heading_rad,
              -std::numbers::pi / 2 - 0.2, 1e-14);
  // World x to 120°, 30° clockwise of east: east is 30° counter-clockwise of x.
  EXPECT_NEAR(in_world(folder.sensors(), EarthOrigin{40, 3, 120}).headings[0].heading_rad,
              std::numbers::pi / 6 - 0.2, 1e-14);
}

// A minute of latitude at 45° is 1852.2 m on WGS 84 (meridian radius 6 367 382 m), a minute of
// longitude there 1314.2 m (6 378 137 / √(1 − e² sin²) · cos 45°).
TEST(FolderSensors, FixesOnEarthBecomeThoseOfTheWorld) {
  FolderFixture fixture;
  fixture.files[kFixes] = kEarth + "0,45.001,3,4,1,9\n1000,45,3.001,4,0,9\n";
  const ImageFolder folder(fixture.write());
  FATHOM_REQUIRE_FEATURE("proj");
  const AbsoluteReadings readings = in_world(folder.sensors(), EarthOrigin{45.0, 3.0, 90.0});
  // World x to the east, y to the north.
  EXPECT_NEAR(readings.fixes[0].position_m.x(), 0.0, 1e-6);
  EXPECT_NEAR(readings.fixes[0].position_m.y(), 6367381.8 * 0.001 * std::numbers::pi / 180, 1e-3);
  EXPECT_NEAR(readings.fixes[1].position_m.x(),
              6388838.3 * std::sqrt(0.5) * 0.001 * std::numbers::pi / 180, 1e-3);
  EXPECT_NEAR(readings.fixes[0].covariance(0, 0), 9.0, 1e-12);
  EXPECT_NEAR(readings.fixes[0].covariance(1, 1), 4.0, 1e-12);
  EXPECT_NEAR(readings.fixes[0].covariance(0, 1), 1.0, 1e-12);
  EXPECT_THAT(input_error_of([&] {
                in_world(folder.sensors(), EarthOrigin{47.0, 3.0, 0.0});
              }),
              HasSubstr("position0/data.csv:2: a fix is 222 km from dataset.origin; expected at "
                        "most 100 km"));
}

TEST(FolderSensors, LatitudeNeedsAnOrigin) {
  FolderFixture fixture;
  fixture.files[kFixes] = "\n" + kEarth + "0,45,3,4,1,9\n";
  const ImageFolder folder(fixture.write());
  EXPECT_EQ(input_error_of([&] { in_world(folder.sensors(), std::nullopt); }),
            (fixture.mav0() / kFixes).string() +
                ":3: fixes in latitude and longitude, and nothing says where the map lies on "
                "Earth; expected dataset.origin: {latitude: , longitude: , heading: }");
}

struct BadSensor {
  const char* name;
  const char* file;
  std::string content;
  std::string message;  ///< after the folder's path
};

class BadSensors : public testing::TestWithParam<BadSensor> {};

TEST_P(BadSensors, AreRefusedWithFileLineAndRemedy) {
  FolderFixture fixture;
  fixture.files[kCompass] = "0,0.1,0.02\n";
  fixture.files[kFixes] = kWorld + "0,1,2,4,0,4\n";
  fixture.files[GetParam().file] = GetParam().content;
  const auto root = fixture.write();
  EXPECT_EQ(input_error_of([&] { const ImageFolder folder(root); }),
            (fixture.mav0() / GetParam().file).string() + GetParam().message);
}

INSTANTIATE_TEST_SUITE_P(
    Rows, BadSensors,
    testing::Values(
        BadSensor{"Degrees", kCompass, "0,1,0.1\n1000,213.5,0.1\n",
                  ":2: heading 213.5 is beyond 2 pi; is it in degrees? expected radians"},
        BadSensor{"HeadingNaN", kCompass, "0,nan,0.1\n",
                  ":1: 'nan' in column 2 of timestamp, heading, sigma is not a finite number"},
        BadSensor{"SigmaZero", kCompass, "0,1,0\n",
                  ":1: sigma 0 is no standard deviation of a heading; expected radians > 0, at "
                  "most pi"},
        BadSensor{"SigmaInDegrees", kCompass, "0,1,5\n",
                  ":1: sigma 5 is no standard deviation of a heading; expected radians > 0, at "
                  "most pi"},
        BadSensor{"NoSigma", kCompass, "0,1\n",
                  ":1: expected 3 columns timestamp, heading, sigma, got 2: '0,1'"},
        BadSensor{"Variances", kCompass, "#timestamp [ns],heading [rad],variance [rad^2]\n0,1,1\n",
                  ":1: the third column is a variance; expected timestamp, heading [rad], sigma "
                  "[rad]: import the bag again, or write square roots"},
        BadSensor{"OtherClock", kCompass, "5000,1,0.1\n6000,1,0.1\n",
                  ": none of 2 headings is at the time of the pictures, 0 to 2000 ns; do both have "
                  "the same clock?"},
        BadSensor{"Convention", kCompassYaml, "convention: clockwise_from_nord\n",
                  ":1: convention: 'clockwise_from_nord' is unknown; expected "
                  "counter_clockwise_from_x or clockwise_from_north; did you mean "
                  "'clockwise_from_north'?"},
        BadSensor{"Mounting", kCompassYaml, "sensor_type: compass\nmounting: {yar: 1}\n",
                  ":2: mounting: 'yar' is unknown; expected x, y (m) and yaw (rad)"},
        BadSensor{"MountingText", kFixesYaml, "mounting: {x: left}\n",
                  ":1: mounting.x: expected a number"},
        BadSensor{"FixBefore", kFixes, kWorld + "0,1,2,4,0,4\n1,1,2,4,0,4\n2001,1,2,4,0,4\n",
                  ":4: a fix at 2001 ns is outside the time of the pictures, 0 to 2000 ns; remove "
                  "its row, or see whether both have the same clock"},
        BadSensor{"VarianceNegative", kFixes, kWorld + "0,1,2,-4,0,4\n",
                  ":2: the covariance of the fix is not positive definite; expected variances > 0 "
                  "and a correlation between -1 and 1"},
        BadSensor{"Correlation", kFixes, kWorld + "0,1,2,4,5,4\n",
                  ":2: the covariance of the fix is not positive definite; expected variances > 0 "
                  "and a correlation between -1 and 1"},
        BadSensor{"FixNaN", kFixes, kWorld + "0,1,nan,4,0,4\n",
                  ":2: 'nan' in column 3 of timestamp, x, y, var_x, cov_xy, var_y is not a finite "
                  "number"},
        BadSensor{"CovarianceText", kFixes, kWorld + "0,1,2,4,;,4\n",
                  ":2: ';' in column 5 of timestamp, x, y, var_x, cov_xy, var_y is not a finite "
                  "number"},
        BadSensor{"NoNames", kFixes, "0,1,2,4,0,4\n",
                  ": does not name its columns; expected a first line #timestamp [ns],x [m],y "
                  "[m],var_x [m^2],cov_xy [m^2],var_y [m^2], or #timestamp [ns],latitude "
                  "[deg],longitude [deg],var_north [m^2],cov_north_east [m^2],var_east [m^2]"},
        BadSensor{"TwoFrames", kFixes, kWorld + "0,1,2,4,0,4\n" + kEarth + "1,45,3,4,0,4\n",
                  ":3: fixes in two frames, x, y and latitude, longitude; expected one of them"},
        BadSensor{"TwoFramesInALine", kFixes, "#t,x,y,latitude,longitude\n0,1,2,4,0,4\n",
                  ":1: fixes in two frames, x, y and latitude, longitude; expected one of them"},
        BadSensor{"LongitudeFirst", kFixes, "#t,longitude,latitude,a,b,c\n0,3,45,4,0,4\n",
                  ":1: expected the columns timestamp [ns],latitude [deg],longitude "
                  "[deg],var_north [m^2],cov_north_east [m^2],var_east [m^2]"},
        BadSensor{"NotOnEarth", kFixes, kEarth + "0,95,3,4,0,4\n",
                  ":2: latitude 95 and longitude 3 are not on Earth; expected degrees, at most 90 "
                  "and 180"}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

TEST(FolderSensors, ASecondPositioningSystemIsRefused) {
  FolderFixture fixture;
  fixture.files["position1/data.csv"] = kEarth + "0,45,3,4,0,4\n";
  const auto root = fixture.write();
  EXPECT_EQ(input_error_of([&] { const ImageFolder folder(root); }),
            (fixture.mav0() / "position1").string() +
                ": is a second positioning system; expected position0 alone, in one frame");
}

TEST(SensorSummary, SaysWhatThereIs) {
  FolderFixture fixture;
  fixture.files[kCompass] = "0,1,0.0174532925\n1000,1,0.0174532925\n2000,1,0.0174532925\n";
  fixture.files[kFixes] = kEarth + "0,45,3,4,0,4\n2000,45,3,4,0,4\n";
  const ImageFolder folder(fixture.write());
  FolderSummary summary;
  sum_up_sensors(folder.sensors(), summary);
  EXPECT_THAT(summary.facts, Contains("compass: 3 headings, one in 1e-06 s, median sigma 1 "
                                      "degrees, mounting yaw 0 rad"));
  EXPECT_THAT(summary.facts, Contains("fixes: 2 in latitude and longitude, one in 2e-06 s, median "
                                      "sigma 2 m, antenna at 0, 0 m"));
  EXPECT_THAT(summary.warnings, IsEmpty());
}

}  // namespace
}  // namespace fathom
