// Axes of dead reckoning, fixes and ground truth, what is configured already, and surveys without
// files of their own for each sensor.

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/front_end/calibration.hpp"
#include "front_end/turning_survey.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr double kQuarter_rad = std::numbers::pi / 2.0;

void add_truth(const TurningSurvey& survey, CalibrationInput& input) {
  for (const std::int64_t time_ns : input.frame_times_ns) {
    input.references.push_back({time_ns, survey.truth(1e-9 * static_cast<double>(time_ns))});
  }
}

// Headings of a compass, and fixes whose x axis points `x_axis_rad` from that of the headings.
void add_compass_and_fixes(const TurningSurvey& survey, double x_axis_rad,
                           CalibrationInput& input) {
  RandomStream stream(2, "axes");
  for (double t = 0.0; t < 74.0; t += 1.0) {
    const Pose truth = survey.truth(t);
    const std::int64_t time_ns = TurningSurvey::nanoseconds(t);
    input.readings.headings.push_back(
        {time_ns, wrap_angle(truth.theta + 0.01 * stream.normal()), 0.01});
    const Eigen::Vector2d position = Eigen::Rotation2Dd(-x_axis_rad) * truth.position();
    input.readings.fixes.push_back(
        {time_ns, position + 0.05 * Eigen::Vector2d(stream.normal(), stream.normal()),
         0.0025 * Eigen::Matrix2d::Identity()});
  }
}

// Rows of a vehicle whose heading is clockwise from north, x east.
void write_clockwise_from_y(CalibrationInput& input) {
  for (ReckonedRow& row : input.odometry.rows) row.heading_rad = kQuarter_rad - row.heading_rad;
  input.odometry.format.convention = OdometryConvention::clockwise_from_y;
}

TEST(CalibrationAxes, FixesInOtherAxesThanTheCompassAreNamed) {
  const TurningSurvey survey;
  CalibrationInput input = survey.input(20);
  add_compass_and_fixes(survey, 0.0, input);
  EXPECT_THAT(calibrate(input).findings, IsEmpty());
  input.readings = {};
  add_compass_and_fixes(survey, kQuarter_rad, input);
  const Calibration found = calibrate(input);
  ASSERT_EQ(found.directions.size(), 1u);
  const Estimated& turned = found.directions.front().turned_rad;
  EXPECT_NEAR(turned.value, -kQuarter_rad, 4.0 * turned.sigma);
  EXPECT_THAT(found.findings,
              ElementsAre(AllOf(HasSubstr("position0 goes -1.5"), HasSubstr("different axes"))));
}

// Exchanged columns fit another convention and a turned camera as well: ground truth tells.
TEST(CalibrationAxes, ExchangedColumnsOfOdometryAreNoConvention) {
  const TurningSurvey survey;
  CalibrationInput input = survey.input(21);
  add_truth(survey, input);
  EXPECT_THAT(calibrate(input).findings, IsEmpty());
  for (ReckonedRow& row : input.odometry.rows) std::swap(row.x_m, row.y_m);
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(AllOf(HasSubstr("ground truth goes"), HasSubstr("exchanged"),
                                Not(HasSubstr("write")))));
}

TEST(CalibrationAxes, PicturesAreMirroredBesideClockwiseFromNorthToo) {
  TurningSurvey survey;
  survey.mount = {0.4, -0.25, 0.5};
  CalibrationInput input = survey.input(22);
  write_clockwise_from_y(input);
  input.camera.mount_x_m = 0.4;
  input.camera.mount_y_m = -0.25;
  input.camera.mount_yaw_rad = 0.5;
  EXPECT_THAT(calibrate(input).findings, IsEmpty());
  mirror_pictures(input);
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(AllOf(HasSubstr("turn opposite ways"), HasSubstr("mirrored: true"),
                                HasSubstr("would tell"))));
  add_truth(survey, input);
  EXPECT_THAT(calibrate(input).findings, ElementsAre(HasSubstr("the pictures are mirrored")));
}

TEST(CalibrationAxes, AMirrorThatIsConfiguredWronglyIsTakenOut) {
  const TurningSurvey survey;
  CalibrationInput input = survey.input(23);
  mirror_pictures(input);
  input.camera.is_mirrored = true;
  add_truth(survey, input);
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(AllOf(HasSubstr("not mirrored, as is configured"),
                                HasSubstr("take 'mirrored: true' out"))));
}

TEST(CalibrationAxes, AScaleIsThatWhichIsSetTimesWhatIsLeft) {
  TurningSurvey survey;
  survey.scale = 1.25;
  CalibrationInput input = survey.input(24);
  input.files.altimeter_scale = 0.3048;
  input.odometry.format.scale = 0.01;
  for (ReckonedRow& row : input.odometry.rows) {
    row.x_m *= 100.0;
    row.y_m *= 100.0;
  }
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(AllOf(HasSubstr("'scale: 0.24"), HasSubstr("'scale: 0.0125"))));
}

TEST(CalibrationAxes, PlainPicturesHaveKeysOfTheDataSet) {
  TurningSurvey survey;
  survey.mount = {0.0, 0.0, 0.4};
  survey.scale = 1.25;
  CalibrationInput input = survey.input(25);
  input.files = {};
  EXPECT_THAT(
      calibrate(input).findings,
      ElementsAre(
          AllOf(HasSubstr("'dataset.camera: {mount_x_m: 0.000"), Not(HasSubstr("sensor.yaml"))),
          AllOf(HasSubstr("'dataset.camera.focal_px' times 1.2"), Not(HasSubstr("sensor.yaml")))));
}

}  // namespace
}  // namespace fathom::test
