#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/front_end/calibration.hpp"
#include "front_end/turning_survey.hpp"
#include "src/front_end/calibration/odometry_track.hpp"
#include "src/front_end/calibration/set_up.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Rows of each convention, written from ours by its own definition.
ReckonedRow written(const ReckonedRow& row, OdometryConvention convention) {
  ReckonedRow other = row;
  const bool is_starboard = convention == OdometryConvention::north_east_down ||
                            convention == OdometryConvention::y_to_starboard;
  if (is_starboard) other.y_m = -row.y_m;
  if (convention == OdometryConvention::north_east_down ||
      convention == OdometryConvention::clockwise_from_x) {
    other.heading_rad = -row.heading_rad;
  }
  if (convention == OdometryConvention::clockwise_from_y) {
    other.heading_rad = std::numbers::pi / 2.0 - row.heading_rad;
  }
  return other;
}

TEST(Calibration, NamesEachConventionOfOdometryOverAllFormatsThatItIsReadIn) {
  const TurningSurvey survey;
  const CalibrationInput right = survey.input(3);
  for (const auto& [word, convention] : odometry_conventions()) {
    for (const bool is_in_degrees : {false, true}) {
      if (!is_in_degrees && convention == OdometryConvention::counter_clockwise_from_x) continue;
      CalibrationInput input = right;
      for (ReckonedRow& row : input.odometry.rows) {
        row = written(row, convention);
        if (is_in_degrees) row.heading_rad *= 180.0 / std::numbers::pi;
      }
      const Calibration found = calibrate(input);
      ASSERT_TRUE(found.set_up);
      EXPECT_EQ(found.set_up->format.convention, convention) << word;
      EXPECT_EQ(found.set_up->format.is_in_degrees, is_in_degrees) << word;
      ASSERT_FALSE(found.findings.empty());
      if (convention != OdometryConvention::counter_clockwise_from_x) {
        EXPECT_THAT(found.findings.back(), HasSubstr("'convention: " + word + "'"));
      }
      if (is_in_degrees) {
        EXPECT_THAT(found.findings.front(), HasSubstr("heading_unit: degrees"));
      }
      // Read as it is written, nothing is wrong.
      input.odometry.format = {convention, is_in_degrees, 1.0};
      EXPECT_THAT(calibrate(input).findings, IsEmpty()) << word;
    }
  }
}

// Mirrored pictures and odometry that is mirrored look alike; another sensor tells.
TEST(Calibration, WhoIsMirroredIsToldByAThirdSensor) {
  const TurningSurvey survey;
  CalibrationInput mirrored = survey.input(4);
  mirror_pictures(mirrored);
  CalibrationInput down = survey.input(4);
  for (ReckonedRow& row : down.odometry.rows) {
    row = written(row, OdometryConvention::north_east_down);
  }
  for (const CalibrationInput& input : {mirrored, down}) {
    EXPECT_THAT(calibrate(input).findings,
                ElementsAre(AllOf(HasSubstr("opposite ways"), HasSubstr("mirrored: true"),
                                  HasSubstr("north_east_down"), HasSubstr("would tell"))));
  }
  std::vector<MeasuredHeading> headings;
  std::vector<StampedPose> references;
  RandomStream stream(1, "compass");
  for (const std::int64_t time_ns : mirrored.frame_times_ns) {
    const Pose truth = survey.truth(1e-9 * static_cast<double>(time_ns));
    headings.push_back({time_ns, wrap_angle(truth.theta + 0.5 + 0.02 * stream.normal()), 0.02});
    references.push_back({time_ns, truth});
  }
  mirrored.readings.headings = down.readings.headings = headings;
  EXPECT_THAT(calibrate(mirrored).findings, ElementsAre(HasSubstr("the pictures are mirrored")));
  EXPECT_THAT(calibrate(down).findings,
              ElementsAre(AllOf(HasSubstr("north, east, down"), HasSubstr("compass0"))));
  mirrored.readings = down.readings = {};
  mirrored.references = down.references = references;
  EXPECT_THAT(calibrate(mirrored).findings, ElementsAre(HasSubstr("the pictures are mirrored")));
  EXPECT_THAT(calibrate(down).findings,
              ElementsAre(AllOf(HasSubstr("north, east, down"), HasSubstr("ground truth"))));
}

// What is to be written is of pictures that are turned round first.
TEST(Calibration, TheMountingOfMirroredPicturesIsThatOfRightOnes) {
  TurningSurvey survey;
  survey.mount = {0.3, 0.2, 0.5};
  CalibrationInput input = survey.input(5);
  mirror_pictures(input);
  for (const std::int64_t time_ns : input.frame_times_ns) {
    input.references.push_back({time_ns, survey.truth(1e-9 * static_cast<double>(time_ns))});
  }
  const Calibration found = calibrate(input);
  ASSERT_EQ(found.findings.size(), 2u);
  EXPECT_THAT(found.findings.back(), AllOf(HasSubstr("x: 0.3"), HasSubstr("yaw: 0.")));
  EXPECT_THAT(found.findings.back(), ::testing::Not(HasSubstr("yaw -")));
}

TEST(Calibration, NamesACompassThatCountsClockwiseAndOneThatIsLate) {
  const TurningSurvey survey;
  CalibrationInput input = survey.input(10);
  const auto with = [&](double sense, double late_s) {
    input.readings.headings.clear();
    RandomStream stream(1, "compass");
    for (double t = 2.0; t < 70.0; t += 0.4) {
      const double heading_rad =
          sense * survey.truth(t - late_s).theta + 0.7 + 0.01 * stream.normal();
      input.readings.headings.push_back(
          {TurningSurvey::nanoseconds(t), wrap_angle(heading_rad), 0.01});
    }
    return calibrate(input);
  };
  EXPECT_THAT(with(1.0, 0.0).findings, IsEmpty());
  EXPECT_THAT(with(-1.0, 0.0).findings, ElementsAre(HasSubstr("compass0 counts the other way")));
  const Calibration late = with(1.0, 1.5);
  ASSERT_EQ(late.turns.size(), 1u);
  ASSERT_TRUE(late.turns.front().time_offset_s);
  const Estimated& offset = *late.turns.front().time_offset_s;
  EXPECT_NEAR(offset.value, -1.5, 4.0 * offset.sigma);
  EXPECT_THAT(late.findings,
              ElementsAre(AllOf(HasSubstr("compass0's time stamps"), HasSubstr("later"))));
}

// Lanes, whose few turns say it all: 0.3 rad/s for 5 s and 10 s straight, 45 s in all.
TEST(Calibration, TheSigmaOfATurnIsThatOfItsScatter) {
  constexpr int kDraws = 300;
  const auto heading = [](double t_s) {
    const double within_s = std::fmod(t_s, 15.0);
    const double turned = 1.5 * std::min(1.0, within_s / 5.0);
    const int lane = static_cast<int>(t_s / 15.0);
    return lane % 2 == 0 ? turned : 1.5 - turned;
  };
  double squares = 0.0;
  int count = 0;
  for (int draw = 0; draw < kDraws; ++draw) {
    RandomStream stream(static_cast<std::uint64_t>(draw), "lanes");
    CalibrationInput input;
    double drift_rad = 0.0;
    for (double t = 0.0; t <= 45.0; t += 0.25) {
      drift_rad += 0.01 * stream.normal();
      const std::int64_t time_ns = TurningSurvey::nanoseconds(t);
      input.odometry.rows.push_back({time_ns, 0.5 * t, 0.0, heading(t) + drift_rad, false});
      input.references.push_back({time_ns, {0.5 * t, 0.0, wrap_angle(heading(t))}});
    }
    const auto turns = compare_turns(input, OdometryTrack(input.odometry, {}));
    if (turns.empty()) continue;
    ++count;
    squares += std::pow((turns.front().slope.value - 1.0) / turns.front().slope.sigma, 2);
  }
  EXPECT_GT(count, 0.95 * kDraws);
  EXPECT_NEAR(std::sqrt(squares / count), 1.05, 0.2);
}

TEST(Calibration, NamesACompassThatStaysWhileTheVehicleTurns) {
  CalibrationInput input = TurningSurvey().input(11);
  for (const std::int64_t time_ns : input.frame_times_ns) {
    input.readings.headings.push_back({time_ns, 0.0, 0.05});
  }
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(HasSubstr("compass0 says 0 rad in each of its 150 headings while "
                                    "odometry0 turns by ")));
  TurningSurvey straight;
  straight.turning_rad = 0.0;
  const auto headings = input.readings.headings;
  input = straight.input(11);
  input.readings.headings = headings;
  EXPECT_THAT(calibrate(input).findings, IsEmpty());
}

TEST(Calibration, NamesFixesWhosePathIsMirrored) {
  const TurningSurvey survey;
  CalibrationInput input = survey.input(11);
  const auto with = [&](double sense) {
    input.readings.fixes.clear();
    RandomStream stream(1, "fixes");
    for (double t = 0.0; t < 74.0; t += 1.0) {
      const Pose truth = survey.truth(t);
      input.readings.fixes.push_back({TurningSurvey::nanoseconds(t),
                                      Eigen::Vector2d(truth.x, sense * truth.y) +
                                          0.05 * Eigen::Vector2d(stream.normal(), stream.normal()),
                                      0.0025 * Eigen::Matrix2d::Identity()});
    }
    return calibrate(input).findings;
  };
  EXPECT_THAT(with(1.0), IsEmpty());
  EXPECT_THAT(with(-1.0), ElementsAre(HasSubstr("position0 is mirrored")));
}

}  // namespace
}  // namespace fathom::test
