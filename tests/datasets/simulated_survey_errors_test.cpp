#include <fstream>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "small_survey.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct BadSurvey {
  const char* name;
  void (*spoil)(SimulatedSurveyOptions&);
  const char* message;  ///< how it must open
};

class BadSurveys : public testing::TestWithParam<BadSurvey> {};

TEST_P(BadSurveys, AreRefusedWithTheirKey) {
  SimulatedSurveyOptions options = test::small_survey();
  GetParam().spoil(options);
  const std::string message = input_error_of([&] { SimulatedSurvey(options, 1); });
  EXPECT_EQ(message.find(GetParam().message), 0U) << message;
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Survey, BadSurveys,
    testing::Values(
        BadSurvey{"AltitudeZero", [](auto& o) { o.altitude.base_m = 0; },
                  "dataset.altitude.base_m: expected a number in m > 0"},
        BadSurvey{"AltitudeNegative", [](auto& o) { o.altitude.base_m = -2; },
                  "dataset.altitude.base_m: "},
        BadSurvey{"AltitudeNaN", [](auto& o) { o.altitude.base_m = kNaN; },
                  "dataset.altitude.base_m: "},
        BadSurvey{"AltitudeReachesZero", [](auto& o) { o.altitude.amplitude_m = 2; },
                  "dataset.altitude.amplitude_m: lets the altitude fall to zero"},
        BadSurvey{"PeriodZero", [](auto& o) { o.altitude.period_s = 0; },
                  "dataset.altitude.period_s: "},
        BadSurvey{"AltimeterTooNoisy", [](auto& o) { o.altitude.altimeter_sigma_m = 5; },
                  "dataset.altitude.altimeter_sigma_m: "},
        BadSurvey{"WidthZero", [](auto& o) { o.camera.base.width = 0; }, "dataset.camera.width: "},
        BadSurvey{"FocalLengthNegative", [](auto& o) { o.camera.base.fx = -500; },
                  "dataset.camera.fx: expected a number in pixels > 0"},
        BadSurvey{"FocalLengthNaN", [](auto& o) { o.camera.base.fy = kNaN; },
                  "dataset.camera.fy: "},
        BadSurvey{"CentreNaN", [](auto& o) { o.camera.cx = kNaN; }, "dataset.camera.cx: "},
        BadSurvey{"MountNaN", [](auto& o) { o.camera.base.mount_yaw_rad = kNaN; },
                  "dataset.camera.mount_yaw_rad: "},
        BadSurvey{"DistortionOfFour",
                  [](auto& o) {
                    o.camera.distortion = {0.1, 0, 0, 0};
                  },
                  "dataset.camera.distortion: expected the 5"},
        BadSurvey{"DistortionNaN",
                  [](auto& o) {
                    o.camera.distortion = {kNaN, 0, 0, 0, 0};
                  },
                  "dataset.camera.distortion: expected the 5"},
        BadSurvey{"DistortionFolds",
                  [](auto& o) {
                    o.camera.distortion = {-2, 0, 0, 0, 0};
                  },
                  "dataset.camera: camera distortion"},
        BadSurvey{"SpeedZero", [](auto& o) { o.mission.speed_m_s = 0; },
                  "dataset.mission.speed_m_s: "},
        BadSurvey{
            "RateInfinite",
            [](auto& o) { o.mission.frame_rate_hz = std::numeric_limits<double>::infinity(); },
            "dataset.mission.frame_rate_hz: "},
        BadSurvey{"NoLegs", [](auto& o) { o.mission.legs = 0; }, "dataset.mission.legs: "},
        BadSurvey{"NoWaypoints", [](auto& o) { o.mission.type = MissionType::kWaypoints; },
                  "dataset.mission.waypoints_m: "},
        BadSurvey{"SigmaZero", [](auto& o) { o.odometry.sigma_theta_rad = 0; },
                  "dataset.odometry.sigma_theta_rad: makes the covariance singular"},
        BadSurvey{"SigmaNegative", [](auto& o) { o.odometry.sigma_x_m = -1; },
                  "dataset.odometry.sigma_x_m: "},
        BadSurvey{"CovarianceSingular", [](auto& o) { o.odometry.covariance = {1, 1, 0, 1, 0, 1}; },
                  "dataset.odometry.covariance: is not positive definite"},
        BadSurvey{"CovarianceNaN", [](auto& o) { o.odometry.covariance = {1, 0, 0, kNaN, 0, 1}; },
                  "dataset.odometry.covariance: "},
        BadSurvey{"ResolutionZero", [](auto& o) { o.world.metres_per_pixel = 0; },
                  "dataset.world.metres_per_pixel: "},
        BadSurvey{"FloorTooLarge", [](auto& o) { o.world.metres_per_pixel = 1e-5; },
                  "dataset.world.metres_per_pixel: the floor"},
        BadSurvey{"OriginOfAProceduralFloor", [](auto& o) { o.world.origin_y_m = 1.0; },
                  "dataset.world.origin_y_m: is for a given picture"},
        BadSurvey{"FloorOfAGivenPicture",
                  [](auto& o) {
                    o.world.picture = "/nowhere/floor.png";
                    o.world.floor = FloorKind::mud;
                  },
                  "dataset.world.floor: is for a procedural floor"},
        BadSurvey{"ReliefNegative", [](auto& o) { o.world.relief_m = -0.1; },
                  "dataset.world.relief_m: "},
        BadSurvey{"ReliefUpToTheCamera", [](auto& o) { o.world.relief_m = 2; },
                  "dataset.world.relief_m: the floor may reach the camera"},
        BadSurvey{"FloorTooLargeForItsPictures", [](auto& o) { o.camera.base.fx = 1e6; },
                  "dataset.world.metres_per_pixel: the floor that the mission sees would have more "
                  "than 1000 million pixels of the 0.000001 m that its pictures need"},
        BadSurvey{"CastOfTwo",
                  [](auto& o) {
                    o.effects.camera.colour_cast = {1, 1};
                  },
                  "dataset.camera_effects.colour_cast: expected three"},
        BadSurvey{"ContrastZero", [](auto& o) { o.effects.camera.contrast = 0; },
                  "dataset.camera_effects.contrast: "},
        BadSurvey{"BackscatterInClearWater", [](auto& o) { o.effects.water.backscatter = 9; },
                  "dataset.water.backscatter: has no effect"},
        BadSurvey{"BothTiltsAndOne",
                  [](auto& o) {
                    o.attitude.both_sigma_rad = 0.01;
                    o.attitude.pitch_sigma_rad = 0.02;
                  },
                  "dataset.attitude.both_sigma_rad: takes the place of"},
        BadSurvey{"CorrelationOfALevelCamera", [](auto& o) { o.attitude.correlation_time_s = 1.0; },
                  "dataset.attitude.correlation_time_s: has no effect"},
        BadSurvey{"CameraSeesTheHorizon",
                  [](auto& o) {
                    o.attitude.roll_sigma_rad = 0.2;
                    o.camera.base.fx = 7;
                  },
                  "dataset.attitude: a camera tilted by"},
        BadSurvey{"PictureMissing", [](auto& o) { o.world.picture = "/nowhere/floor.png"; },
                  "/nowhere/floor.png: cannot be opened"}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

TEST(SimulatedSurveyErrors, FrameBeyondThePictureSaysWhichAndByHowMuch) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(test::write_picture(folder / "w.png", cv::Mat(501, 501, CV_8UC1, cv::Scalar(9))));
  SimulatedSurveyOptions options = test::small_survey();
  options.world.picture = (folder / "w.png").string();
  options.world.metres_per_pixel = 0.01;
  options.world.origin_x_m = 0.0;
  options.world.origin_y_m = 0.0;
  options.mission.type = MissionType::kWaypoints;
  options.mission.waypoints_m = {0, 0, 3, 0};
  // Ahead it sees 2 m · 24 / 52 = 0.923 m; the picture ends 2.5 m from its middle, so the frame
  // at 1.75 m, the eighth of 0.25 m, is the first to see beyond, by 0.17 m.
  const std::string message = input_error_of([&] { SimulatedSurvey(options, 1); });
  EXPECT_EQ(message.find("dataset.world.picture: frame 7 at 3.500000000 s sees 0.17 m beyond the "
                         "picture's top"),
            0U)
      << message;
}

TEST(SimulatedSurveyErrors, PictureThatJustFitsIsTaken) {
  const test::TemporaryFolder folder;
  SimulatedSurveyOptions options = test::small_survey();
  options.mission.type = MissionType::kWaypoints;
  options.mission.waypoints_m = {0, 0, 3, 0};
  options.world.picture = (folder / "w.png").string();
  options.world.metres_per_pixel = 0.01;
  // 3 m + 2 · 0.923 m up, 2 · 2 m · 32 / 50 = 2.56 m across.
  ASSERT_TRUE(
      test::write_picture(options.world.picture, cv::Mat(486, 258, CV_8UC1, cv::Scalar(9))));
  EXPECT_EQ(input_error_of([&] { SimulatedSurvey(options, 1); }), "(nothing thrown)");
  ASSERT_TRUE(
      test::write_picture(options.world.picture, cv::Mat(484, 258, CV_8UC1, cv::Scalar(9))));
  EXPECT_NE(input_error_of([&] { SimulatedSurvey(options, 1); }), "(nothing thrown)");
  ASSERT_TRUE(
      test::write_picture(options.world.picture, cv::Mat(486, 256, CV_8UC1, cv::Scalar(9))));
  EXPECT_NE(input_error_of([&] { SimulatedSurvey(options, 1); }), "(nothing thrown)");
}

TEST(SimulatedSurveyErrors, PictureThatIsNoneIsRefused) {
  const test::TemporaryFolder folder;
  SimulatedSurveyOptions options = test::small_survey();
  options.world.picture = (folder / "w.png").string();
  std::ofstream(options.world.picture) << "not a picture";
  const std::string message = input_error_of([&] { SimulatedSurvey(options, 1); });
  EXPECT_NE(message.find("w.png: is no picture"), std::string::npos) << message;
}

TEST(SimulatedSurveyErrors, EveryKeyIsDescribedOnce) {
  SimulatedSurveyOptions options;
  OptionTable table;
  table.group("dataset", options);
  for (const char* key :
       {"dataset.world.picture", "dataset.world.metres_per_pixel", "dataset.mission.type",
        "dataset.mission.waypoints_m", "dataset.camera.fx", "dataset.camera.distortion",
        "dataset.altitude.base_m", "dataset.odometry.sigma_x_m", "dataset.odometry.source"}) {
    EXPECT_TRUE(table.has(key)) << key;
  }
  table.set("dataset.mission.type", OptionValue::scalar("single_loop"));
  table.set("dataset.odometry.source", OptionValue::scalar("visual_odometry"));
  EXPECT_EQ(options.mission.type, MissionType::kSingleLoop);
  EXPECT_EQ(options.odometry.source, OdometrySource::kVisualOdometry);
  for (const OptionDescription& option : table.descriptions()) {
    EXPECT_FALSE(option.help.empty()) << option.key;
  }
}

}  // namespace
}  // namespace fathom
