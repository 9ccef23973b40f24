// Roll and pitch as a sensor has them: of a simulated survey, and of an image folder.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/datasets/folder_summary.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/vision/registration.hpp"
#include "flat_world.hpp"
#include "folder_fixture.hpp"
#include "small_survey.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using test::input_error_of;
using testing::Contains;
using testing::HasSubstr;
using testing::Not;

const char* const kAttitude = "attitude0/data.csv";

SimulatedSurveyOptions measured_rolling_survey() {
  SimulatedSurveyOptions options = test::small_survey();
  options.attitude.both_sigma_rad = 0.03;
  options.attitude.measured_sigma_rad = 0.002;
  return options;
}

// An arrow's tip on the floor, in the picture of a tilted camera, is where the projection puts it;
// and the other way round.
TEST(MeasuredAttitude, ADrawnTipFallsWhereTheProjectionSays) {
  CameraModel model;
  model.mount_x_m = 0.2;
  model.mount_y_m = -0.1;
  model.mount_yaw_rad = 0.3;
  const Camera camera(model);
  const Eigen::Vector2d tip(0.4, 0.5);
  const FloorRenderer renderer = test::renderer_of(test::dot_world(tip), model);
  const Pose pose{0.1, -0.05, 0.5};
  for (const Tilt& tilt : {Tilt{0.1, 0.0}, Tilt{0.0, 0.1}, Tilt{-0.12, 0.08}}) {
    const Stance stance(2.0, tilt);
    const Eigen::Vector2d seen = test::dot_in(renderer.render({pose, 2.0, tilt}));
    EXPECT_LT((seen - camera.pixel(transform(inverse(pose), tip), stance)).norm(), 0.15);
    EXPECT_LT((transform(pose, camera.floor_point(seen, stance)) - tip).norm(), 0.001);
    EXPECT_GT((transform(pose, camera.floor_point(seen, 2.0)) - tip).norm(), 0.15);
  }
}

TEST(MeasuredAttitude, IsTheTrueOneWithNoiseAndMountingError) {
  AttitudeOptions options;
  options.measured_sigma_rad = 0.01;
  options.roll_mounting_error_rad = 0.05;
  options.pitch_mounting_error_rad = -0.02;
  const std::vector<Tilt> truth(20'000, Tilt{0.1, 0.2});
  const auto measured = measure_attitude(options, truth, 3);
  ASSERT_EQ(measured.size(), truth.size());
  Eigen::Array2d sum(0, 0), squares(0, 0);
  double product = 0.0;
  for (const MeasuredTilt& one : measured) {
    EXPECT_EQ(one.sigma_rad, 0.01);
    const Eigen::Array2d error(one.tilt.roll_rad - 0.15, one.tilt.pitch_rad - 0.18);
    sum += error / 2e4;
    squares += error.square() / 2e4;
    product += error.x() * error.y() / 2e4;
  }
  EXPECT_LT(sum.abs().maxCoeff(), 4 * 0.01 / std::sqrt(2e4));
  EXPECT_LT((squares.sqrt() - 0.01).abs().maxCoeff(), 0.0003);
  EXPECT_LT(std::abs(product), 0.04 * 0.01 * 0.01);
  EXPECT_NE(measured[0], measure_attitude(options, truth, 4)[0]);
  options.measured_sigma_rad.reset();
  EXPECT_TRUE(measure_attitude(options, truth, 3).empty());
}

// All else of a survey is what it is without.
TEST(MeasuredAttitude, LeavesPicturesAltitudesAndMotionsAsTheyAre) {
  SimulatedSurveyOptions options = measured_rolling_survey();
  const SimulatedSurvey with(options, 5);
  options.attitude.measured_sigma_rad.reset();
  const SimulatedSurvey without(options, 5);
  EXPECT_TRUE(with.has_attitude());
  EXPECT_FALSE(without.has_attitude());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with.picture_id(i), without.picture_id(i));
    EXPECT_EQ(with.info(i).altitude_m, without.info(i).altitude_m);
    EXPECT_EQ(with.true_tilt(i), without.true_tilt(i));
    EXPECT_NEAR(with.info(i).tilt->tilt.roll_rad, with.true_tilt(i).roll_rad, 0.01);
    EXPECT_TRUE(without.info(i).stance().is_level());
    if (i > 0) {
      EXPECT_TRUE(with.info(i).motion->mean == without.info(i).motion->mean);
    }
  }
  EXPECT_TRUE(with.remeasured({}, 1, 7).has_attitude());
}

TEST(MeasuredAttitude, TakesTheTiltOutOfARegistration) {
  SimulatedSurveyOptions options;
  options.mission.type = MissionType::kWaypoints;
  options.mission.waypoints_m = {0, 0, 1, 0};
  options.attitude.both_sigma_rad = 0.03;
  options.attitude.measured_sigma_rad = 0.0;
  options.altitude.altimeter_sigma_m = 0.0;
  const SimulatedSurvey survey(options, 2);
  const auto error_m = [&](bool is_told) {
    const auto seen = [&](std::size_t i) {
      return on_floor(FeatureExtractor().extract(survey.image(i)), survey.camera(),
                      survey.info(i).altitude_m, is_told ? survey.info(i).tilt : std::nullopt);
    };
    const Registration found = register_pair(seen(0), seen(2), {}, 1);
    EXPECT_TRUE(found.found);
    const Pose truth = between(*survey.info(0).ground_truth, *survey.info(2).ground_truth);
    return (found.motion.position() - truth.position()).norm();
  };
  EXPECT_LT(error_m(true), 0.001);
  EXPECT_GT(error_m(false), 0.01);
}

TEST(MeasuredAttitude, IsWrittenAndReadBackToTheSameBits) {
  const test::TemporaryFolder folder;
  const SimulatedSurvey survey(measured_rolling_survey(), 6);
  write_image_folder(survey, folder / "out");
  const ImageFolder read(folder / "out");
  ASSERT_TRUE(read.has_attitude());
  for (std::size_t i = 0; i < read.size(); ++i) EXPECT_EQ(read.info(i).tilt, survey.info(i).tilt);
  write_image_folder(SimulatedSurvey(test::small_survey(), 6), folder / "level");
  EXPECT_FALSE(std::filesystem::exists(folder / "level" / "mav0" / "attitude0"));
  EXPECT_FALSE(ImageFolder(folder / "level").has_attitude());
}

TEST(AttitudeFolder, OtherRatesAreInterpolated) {
  FolderFixture fixture;
  fixture.files[kAttitude] =
      "#timestamp [ns],roll [rad],pitch [rad],sigma [rad]\n"
      "0,0.02,-0.1,0.001\n800,0,0.1,0.002\n1200,0.1,0.2,0.004\n2000,-0.3,0,0\n";
  const ImageFolder folder(fixture.write());
  EXPECT_EQ(folder.info(0).tilt, (MeasuredTilt{{0.02, -0.1}, 0.001}));
  EXPECT_NEAR(folder.info(1).tilt->tilt.roll_rad, 0.05, 1e-15);
  EXPECT_NEAR(folder.info(1).tilt->tilt.pitch_rad, 0.15, 1e-15);
  EXPECT_NEAR(folder.info(1).tilt->sigma_rad, 0.003, 1e-15);
  EXPECT_EQ(folder.info(2).stance(), Stance(3.0, Tilt{-0.3, 0.0}));
}

TEST(AttitudeFolder, CheckSaysDegrees) {
  FolderFixture fixture;
  EXPECT_THAT(summarise_frames(ImageFolder(fixture.write())).facts,
              Not(Contains(HasSubstr("attitude"))));
  fixture.files[kAttitude] = "0,0.0174533,-0.1,0.00174533\n2000,0.0349066,0.9,0.00174533\n";
  const FolderSummary summary = summarise_frames(ImageFolder(fixture.write()));
  EXPECT_THAT(summary.facts,
              Contains("attitude: roll 1 to 2 degrees, pitch -5.73 to 51.57 degrees, median sigma "
                       "0.1 degrees"));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("in radians?: 2 (frames 1, 2)")));
}

struct BadAttitude {
  const char* rows;
  const char* message;
};

TEST(AttitudeFolder, BadOnesAreRefusedWithFileLineAndRemedy) {
  const BadAttitude bad[] = {
      {"0,0,0,0\n1000,1.2,0,0\n", "data.csv:2: roll 1.2 is beyond 1 rad (57 degrees); are these "},
      {"0,0,0,0\n1000,0,-3.1,0\n", "data.csv:2: pitch -3.1 is beyond 1 rad"},
      {"0,nan,0,0\n", "data.csv:1: 'nan' in column 2"},
      {"0,0,inf,0\n", "data.csv:1: 'inf' in column 3"},
      {"0,0,0,nan\n", "data.csv:1: 'nan' in column 4"},
      {"0,0,0\n", "data.csv:1: expected 4 columns timestamp, roll, pitch, sigma, got 3"},
      {"0,0,0,\n", "data.csv:1: '' in column 4"},
      {"0,0,0,-0.1\n", "data.csv:1: sigma -0.1 is no standard deviation of roll and pitch; exp"},
      {"0,0,0,0.6\n", "data.csv:1: sigma 0.6 is no standard deviation"},
      {"", "data.csv: has no data; expected rows of timestamp, roll, pitch, sigma"},
      {"0,0,0,0\n1000,0,0,0\n", "no roll and pitch at or around the picture's time 2000 ns"},
      {"1,0,0,0\n2000,0,0,0\n", "no roll and pitch at or around the picture's time 0 ns"},
      {"0,0,0,0\n1000,0,0,0\n2001001001,0,0,0\n", "no roll and pitch at or around the picture's"},
      {"0,0,0,0\n2000,0,0,0\n1000,0,0,0\n", "data.csv:3: time stamp '1000' does not come after"}};
  for (const BadAttitude& one : bad) {
    FolderFixture fixture;
    fixture.files[kAttitude] = one.rows;
    const auto root = fixture.write();
    const std::string message = input_error_of([&] { const ImageFolder folder(root); });
    EXPECT_EQ(message.find((fixture.mav0() / "attitude0").string()), 0U) << message;
    EXPECT_THAT(message, HasSubstr(one.message));
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST(AttitudeFolder, WithoutItsFileOrWithTheHorizonIsRefused) {
  FolderFixture fixture;
  fixture.files["attitude0/sensor.yaml"] = "sensor_type: attitude\n";
  const auto root = fixture.write();
  EXPECT_THAT(input_error_of([&] { const ImageFolder folder(root); }),
              HasSubstr("data.csv: cannot be opened"));
  FolderFixture wide;
  wide.files["cam0/sensor.yaml"] = "resolution: [8, 6]\nintrinsics: [2, 2, 3.5, 2.5]\n";
  wide.files[kAttitude] = "0,0,0,0\n1000,0.9,0,0\n2000,0,0,0\n";
  const auto wide_root = wide.write();
  EXPECT_THAT(input_error_of([&] { const ImageFolder folder(wide_root); }),
              HasSubstr("attitude0/data.csv: at the picture's time 1000 ns a camera tilted by "));
}

TEST(MeasuredAttitude, BadOptionsAreRefusedByKey) {
  const auto refused = [](auto change) {
    SimulatedSurveyOptions options = test::small_survey();
    change(options.attitude);
    return input_error_of([&] { const SimulatedSurvey survey(options, 1); });
  };
  EXPECT_THAT(refused([](auto& o) { o.measured_sigma_rad = -0.1; }),
              HasSubstr("dataset.attitude.measured_sigma_rad"));
  EXPECT_THAT(refused([](auto& o) { o.roll_mounting_error_rad = 0.01; }),
              HasSubstr("dataset.attitude.roll_mounting_error_rad: has no effect on what is not"));
  EXPECT_THAT(refused([](auto& o) { o.pitch_mounting_error_rad = 0.01; }),
              HasSubstr("dataset.attitude.pitch_mounting_error_rad: has no effect"));
}

}  // namespace
}  // namespace fathom
