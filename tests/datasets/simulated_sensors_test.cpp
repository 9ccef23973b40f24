// Simulated compass, fixes and holes, against their closed forms.

#include "fathom/datasets/simulated_sensors.hpp"

#include <cmath>
#include <numbers>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "datasets/small_log.hpp"
#include "datasets/small_survey.hpp"
#include "fathom/datasets/reading_carrier.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::flown;
using test::input_error_of;
using test::sweep;

/// Straight ahead along y, so that the heading is constant, for a thousand seconds.
std::vector<StampedPose> straight() {
  std::vector<StampedPose> way;
  for (std::int64_t i = 0; i <= 2000; ++i) {
    way.push_back({i * 500'000'000, {1.0, 0.25 * static_cast<double>(i), 1.5}});
  }
  return way;
}

/// Turning on the spot, once in a hundred seconds.
std::vector<StampedPose> turning() {
  std::vector<StampedPose> way;
  for (std::int64_t i = 0; i <= 2000; ++i) {
    const double heading_rad = 2.0 * std::numbers::pi * static_cast<double>(i) / 200.0;
    way.push_back({i * 500'000'000, {0.0, 0.0, wrap_angle(heading_rad)}});
  }
  return way;
}

AbsoluteReadings drawn(const SimulatedSensorOptions& options, const std::vector<StampedPose>& way,
                       std::uint64_t trial = 0) {
  return draw_readings(options, way, 7, trial, "dataset.");
}

TEST(SimulatedSensors, NoneUnlessAskedFor) {
  EXPECT_TRUE(drawn({}, straight()).is_empty());
  const FlownKeyframes keyframes = flown(sweep());
  const MeasurementLog log = draw_log(keyframes, sweep(), 1, 0);
  EXPECT_TRUE(log.start().is_fixed());
  EXPECT_EQ(log.absolute_count() + log.hole_count(), 0u);
}

TEST(SimulatedSensors, ACompassHasItsNoiseAndBias) {
  SimulatedSensorOptions options;
  options.compass.interval_s = 0.2;
  options.compass.sigma_rad = 0.03;
  options.compass.bias_rad = -0.05;
  const auto headings = drawn(options, straight()).headings;
  ASSERT_EQ(headings.size(), 5001u);
  EXPECT_EQ(headings[3].time_ns, 600'000'000);
  double sum = 0.0;
  double squares = 0.0;
  for (const MeasuredHeading& reading : headings) {
    EXPECT_EQ(reading.sigma_rad, 0.03);
    sum += reading.heading_rad - 1.5;
    squares += std::pow(reading.heading_rad - 1.5 + 0.05, 2);
  }
  // Three standard deviations of a mean and of a variance of 5001 draws.
  EXPECT_NEAR(sum / 5001, -0.05, 3 * 0.03 / std::sqrt(5001.0));
  EXPECT_NEAR(squares / 5001, 0.0009, 3 * 0.0009 * std::sqrt(2.0 / 5001.0));
}

// Deviation: a sine of the heading, the same at every turn, of the asked amplitude; its mean over a
// turn is zero.
TEST(SimulatedSensors, DeviationIsASineOfTheHeading) {
  SimulatedSensorOptions options;
  options.compass.interval_s = 0.5;
  options.compass.sigma_rad = 1e-12;
  options.compass.deviation_rad = 0.1;
  const auto way = turning();
  const auto headings = drawn(options, way).headings;
  double least = 0.0;
  double most = 0.0;
  double sum = 0.0;
  for (std::size_t i = 0; i < 2000; ++i) {
    const double error = test::angle_between(headings[i].heading_rad, way[i].pose.theta);
    least = std::min(least, error);
    most = std::max(most, error);
    sum += error;
    if (i >= 200) {
      EXPECT_NEAR(
          error, test::angle_between(headings[i - 200].heading_rad, way[i - 200].pose.theta), 1e-9);
    }
  }
  EXPECT_NEAR(most, 0.1, 1e-4);
  EXPECT_NEAR(least, -0.1, 1e-4);
  EXPECT_NEAR(sum / 2000, 0.0, 1e-9);
}

TEST(SimulatedSensors, FixesHaveTheirCovariance) {
  SimulatedSensorOptions options;
  options.fixes.interval_s = 0.25;
  options.fixes.covariance = {4.0, -1.0, 1.0};
  options.fixes.lever_x_m = 2.0;
  const auto readings = drawn(options, straight());
  EXPECT_EQ(readings.lever_m, Eigen::Vector2d(2.0, 0.0));
  ASSERT_EQ(readings.fixes.size(), 4001u);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const PositionFix& fix : readings.fixes) {
    const double t = 1e-9 * static_cast<double>(fix.time_ns);
    const Eigen::Vector2d antenna(1.0 + 2.0 * std::cos(1.5), 0.5 * t + 2.0 * std::sin(1.5));
    const Eigen::Vector2d e = fix.position_m - antenna;
    sum += e * e.transpose() / 4001.0;
  }
  EXPECT_NEAR(sum(0, 0), 4.0, 3 * 4.0 * std::sqrt(2.0 / 4001.0));
  EXPECT_NEAR(sum(1, 1), 1.0, 3 * std::sqrt(2.0 / 4001.0));
  EXPECT_NEAR(sum(0, 1), -1.0, 3 * std::sqrt((4.0 + 1.0) / 4001.0));
  EXPECT_EQ(readings.fixes[7].covariance(0, 1), -1.0);
}

TEST(SimulatedSensors, JumpsHaveTheirShareAndSizeInAnyDirection) {
  SimulatedSensorOptions options;
  options.fixes.interval_s = 0.25;
  options.fixes.sigma_m = 0.01;
  options.fixes.jump_share = 0.2;
  options.fixes.jump_m = 20.0;
  std::size_t jumps = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const PositionFix& fix : drawn(options, straight()).fixes) {
    const double t = 1e-9 * static_cast<double>(fix.time_ns);
    const Eigen::Vector2d e = fix.position_m - Eigen::Vector2d(1.0, 0.5 * t);
    if (e.norm() < 1.0) continue;
    EXPECT_NEAR(e.norm(), 20.0, 0.1);
    sum += e;
    ++jumps;
  }
  EXPECT_NEAR(static_cast<double>(jumps), 800.0, 3 * std::sqrt(4001 * 0.2 * 0.8));
  EXPECT_LT(sum.norm() / static_cast<double>(jumps), 20.0 * 3.0 / std::sqrt(800.0));
}

TEST(SimulatedSensors, LatencyIsWhereTheAntennaWas) {
  SimulatedSensorOptions options;
  options.fixes.interval_s = 10.0;
  options.fixes.sigma_m = 1e-9;
  options.fixes.latency_s = 3.0;
  const auto fixes = drawn(options, straight()).fixes;
  EXPECT_NEAR(fixes[0].position_m.y(), 0.0, 1e-6);
  EXPECT_NEAR(fixes[5].position_m.y(), 0.5 * 47.0, 1e-6);
}

// The size of one error changes no other draw.
TEST(SimulatedSensors, StreamsAreTheirOwn) {
  SimulatedSensorOptions options;
  options.compass.interval_s = 1.0;
  options.fixes.interval_s = 1.0;
  const auto plain = drawn(options, straight());
  options.fixes.jump_share = 0.5;
  options.compass.deviation_rad = 0.2;
  const auto other = drawn(options, straight());
  std::size_t same = 0;
  for (std::size_t i = 0; i < plain.fixes.size(); ++i) {
    same += plain.fixes[i].position_m == other.fixes[i].position_m ? 1 : 0;
  }
  EXPECT_GT(same, 400u);
  EXPECT_LT(same, 600u);
  EXPECT_NE(drawn(options, straight(), 1).headings[3].heading_rad,
            drawn(options, straight(), 0).headings[3].heading_rad);
  // Nor dead reckoning and registrations of a log.
  SimulatedLogOptions log = sweep();
  const FlownKeyframes keyframes = flown(log);
  const MeasurementLog without = draw_log(keyframes, log, 1, 0);
  log.sensors = options;
  const MeasurementLog with = draw_log(keyframes, log, 1, 0);
  ASSERT_GT(with.absolute_count(), 10u);
  for (std::size_t k = 1; k < without.size(); ++k) {
    EXPECT_EQ(with.arrival(k).step.motion, without.arrival(k).step.motion);
    ASSERT_EQ(with.arrival(k).registrations.size(), without.arrival(k).registrations.size());
  }
}

TEST(SimulatedSensors, RefusesWhatCannotBe) {
  SimulatedSensorOptions options;
  options.fixes.interval_s = 1e-9;
  EXPECT_EQ(input_error_of([&] { drawn(options, straight()); }),
            "dataset.fixes.interval_s: expected a number in s >= 0.001");
  options.fixes.interval_s = 1.0;
  options.fixes.sigma_m = 0.0;
  EXPECT_EQ(input_error_of([&] { drawn(options, straight()); }),
            "dataset.fixes.sigma_m: makes the covariance singular; expected a number > 0");
  options.fixes.covariance = {1.0, 2.0, 1.0};
  EXPECT_EQ(input_error_of([&] { drawn(options, straight()); }),
            "dataset.fixes.covariance: is not positive definite; expected xx, yy > 0 and a "
            "correlation between -1 and 1");
  options.fixes.covariance = {1.0, 2.0};
  EXPECT_EQ(input_error_of([&] { drawn(options, straight()); }),
            "dataset.fixes.covariance: expected three numbers [xx, xy, yy], or []");
}

TEST(SimulatedSensors, ASurveyMeasuresThemInEachTrial) {
  SimulatedSurveyOptions options = test::small_survey();
  options.sensors.compass.interval_s = 1.0;
  options.sensors.fixes.interval_s = 3.0;
  options.sensors.holes = {1, 2.0};
  const SimulatedSurvey survey(options, 4, 2);
  const SimulatedSurvey again =
      SimulatedSurvey(test::small_survey(), 4).remeasured(options.odometry, options.sensors, 4, 2);
  ASSERT_EQ(survey.readings().fixes.size(), again.readings().fixes.size());
  EXPECT_EQ(survey.readings().fixes[1].position_m, again.readings().fixes[1].position_m);
  std::size_t holes = 0;
  for (std::size_t i = 1; i < survey.size(); ++i) {
    EXPECT_EQ(survey.info(i).is_hole, again.info(i).is_hole);
    holes += survey.info(i).is_hole ? 1 : 0;
  }
  EXPECT_EQ(holes, 4u);
  EXPECT_TRUE(survey.remeasured(options.odometry, 4, 2).readings().is_empty());
}

}  // namespace
}  // namespace fathom
