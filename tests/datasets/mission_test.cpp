#include "fathom/datasets/mission.hpp"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "fathom/core/input_error.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::input_error_of;

MissionOptions of_type(MissionType type) {
  MissionOptions options;
  options.type = type;
  options.waypoints_m = {3, 1, 7, 4, 7, 12, -2, 5};
  return options;
}

class EveryMission : public testing::TestWithParam<MissionType> {};

TEST_P(EveryMission, StartsAtTheIdentity) {
  EXPECT_LT(test::distance(fly_mission(of_type(GetParam()), "").front().pose, Pose{}), 1e-12);
}

TEST_P(EveryMission, StampsFollowTheFrameRate) {
  MissionOptions options = of_type(GetParam());
  options.frame_rate_hz = 3.0;
  const auto poses = fly_mission(options, "");
  ASSERT_GT(poses.size(), 20U);
  EXPECT_EQ(poses[1].time_ns, 333'333'333);
  EXPECT_EQ(poses[2].time_ns, 666'666'667);
  EXPECT_EQ(poses[3].time_ns, 1'000'000'000);
}

// Between two frames the chord is as long as the path or, by a bend's curvature, a little shorter;
// on a circle of radius r the chord of an arc s is 2 r sin(s / 2r).
TEST_P(EveryMission, FramesAreSpeedOverRateApart) {
  MissionOptions options = of_type(GetParam());
  options.speed_m_s = 0.7;
  options.frame_rate_hz = 5.0;
  const double arc = 0.14;
  const double least = 2 * options.turn_radius_m * std::sin(arc / (2 * options.turn_radius_m));
  const auto poses = fly_mission(options, "");
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const double chord = (poses[i].pose.position() - poses[i - 1].pose.position()).norm();
    EXPECT_LE(chord, arc + 1e-9) << i;
    EXPECT_GE(chord, least - 1e-9) << i;
  }
}

TEST_P(EveryMission, HeadingIsTangentToThePath) {
  MissionOptions options = of_type(GetParam());
  options.frame_rate_hz = 500.0;
  const auto poses = fly_mission(options, "");
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const Eigen::Vector2d along = poses[i + 1].pose.position() - poses[i - 1].pose.position();
    const double tangent = std::atan2(along.y(), along.x());
    EXPECT_LT(std::abs(test::angle_between(tangent, poses[i].pose.theta)), 2e-3) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Missions, EveryMission,
                         testing::Values(MissionType::kSweep, MissionType::kSingleLoop,
                                         MissionType::kWaypoints));

TEST(Mission, SweepWorksToPortInLegsOfTheSpacing) {
  MissionOptions options;
  options.legs = 3;
  options.leg_length_m = 8.0;
  options.leg_spacing_m = 2.0;
  options.turn_radius_m = 0.4;
  options.frame_rate_hz = 50.0;
  int on_first = 0;
  int on_second = 0;
  int on_third = 0;
  for (const StampedPose& frame : fly_mission(options, "")) {
    const Pose& p = frame.pose;
    EXPECT_GT(p.x, -1e-9);
    EXPECT_LT(p.x, 8.0 + 1e-9);
    if (p.x < 1.0 || p.x > 7.0) continue;
    on_first += std::abs(p.y) < 1e-9 && std::abs(p.theta) < 1e-9 ? 1 : 0;
    on_second += std::abs(p.y - 2.0) < 1e-9 && std::abs(p.theta) > 3.14159 ? 1 : 0;
    on_third += std::abs(p.y - 4.0) < 1e-9 && std::abs(p.theta) < 1e-9 ? 1 : 0;
  }
  // Six metres of each leg at one frame a centimetre.
  EXPECT_NEAR(on_first, 600, 2);
  EXPECT_NEAR(on_second, 600, 2);
  EXPECT_NEAR(on_third, 600, 2);
}

TEST(Mission, TurnsOfHalfTheSpacingLeaveNoStraightBetween) {
  MissionOptions options;
  options.turn_radius_m = options.leg_spacing_m / 2;
  const double length = 4 * 10.0 - 6 * 0.7 + 3 * std::numbers::pi * 0.7;
  EXPECT_EQ(fly_mission(options, "").size(), static_cast<std::size_t>(length / 0.25) + 1);
}

// The perimeter with corners cut short: a rounded right angle saves (2 − π/2) r.
TEST(Mission, LoopReturnsToItsStartAndGoesOn) {
  MissionOptions options;
  options.type = MissionType::kSingleLoop;
  options.turn_radius_m = 1.0;
  options.loop_overrun_m = 1.5;
  options.frame_rate_hz = 1000.0;
  const auto poses = fly_mission(options, "");
  const double perimeter = 2 * (10.0 + 6.0) - 4 * (2 - std::numbers::pi / 2);
  const auto round = static_cast<std::size_t>(std::llround(perimeter / 0.5 * 1000.0));
  ASSERT_LT(round, poses.size());
  EXPECT_LT(test::distance(poses[round].pose, poses.front().pose), 5e-4);
  EXPECT_NEAR(poses.back().pose.x, 1.5, 1e-3);
  EXPECT_NEAR(poses.back().pose.y, 0.0, 1e-9);
}

TEST(Mission, WaypointsAreSeenFromTheFirst) {
  MissionOptions options;
  options.type = MissionType::kWaypoints;
  options.waypoints_m = {5, 5, 5, 9, 1, 9};  // up, then left
  options.speed_m_s = 1.0;
  options.frame_rate_hz = 1000.0;
  const Pose end = fly_mission(options, "").back().pose;
  EXPECT_NEAR(end.x, 4.0, 1e-9);
  EXPECT_NEAR(end.y, 4.0, 2e-3);
  EXPECT_NEAR(end.theta, std::numbers::pi / 2, 1e-9);
}

TEST(Mission, LastFrameIsOnTheEndWhereTheLengthIsAMultiple) {
  MissionOptions options;
  options.type = MissionType::kWaypoints;
  options.waypoints_m = {0, 0, 2.1, 0};
  options.speed_m_s = 0.7;
  options.frame_rate_hz = 10.0;
  const auto poses = fly_mission(options, "");
  ASSERT_EQ(poses.size(), 31U);
  EXPECT_NEAR(poses.back().pose.x, 2.1, 1e-12);
}

struct BadMission {
  const char* name;
  void (*spoil)(MissionOptions&);
  const char* message;
};

class BadMissions : public testing::TestWithParam<BadMission> {};

TEST_P(BadMissions, AreRefusedWithTheirKey) {
  MissionOptions options;
  GetParam().spoil(options);
  EXPECT_EQ(input_error_of([&] { fly_mission(options, "m."); }).find(GetParam().message), 0U)
      << input_error_of([&] { fly_mission(options, "m."); });
}

void as_waypoints(MissionOptions& options, std::vector<double> points) {
  options.type = MissionType::kWaypoints;
  options.waypoints_m = std::move(points);
}

INSTANTIATE_TEST_SUITE_P(
    Mission, BadMissions,
    testing::Values(
        BadMission{"NoWaypoints", [](auto& o) { as_waypoints(o, {}); }, "m.waypoints_m: "},
        BadMission{"OneWaypoint",
                   [](auto& o) {
                     as_waypoints(o, {1, 2});
                   },
                   "m.waypoints_m: "},
        BadMission{"OddCount",
                   [](auto& o) {
                     as_waypoints(o, {1, 2, 3, 4, 5});
                   },
                   "m.waypoints_m: expected at least two"},
        BadMission{"NaN",
                   [](auto& o) {
                     as_waypoints(o, {1, 2, 3, std::nan("")});
                   },
                   "m.waypoints_m: expected finite"},
        BadMission{"SamePointTwice",
                   [](auto& o) {
                     as_waypoints(o, {1, 2, 1, 2, 5, 5});
                   },
                   "m.waypoints_m: the side from point 1 to 2"},
        BadMission{"TurnsBackOnItself",
                   [](auto& o) {
                     as_waypoints(o, {0, 0, 5, 0, 1, 0});
                   },
                   "m.waypoints_m: the side from point 1 to 2 is too short"},
        BadMission{"TurnTooWide", [](auto& o) { o.turn_radius_m = 0.71; },
                   "m.leg_spacing_m: the side from point 2 to 3 is too short"},
        BadMission{"LoopTooNarrow",
                   [](auto& o) {
                     o.type = MissionType::kSingleLoop;
                     o.loop_width_m = 0.9;
                   },
                   "m.loop_width_m: the side from point 2 to 3 is too short"},
        BadMission{"TooManyFrames", [](auto& o) { o.speed_m_s = 1e-6; }, "m.frame_rate_hz: "}),
    [](const auto& test_case) { return std::string(test_case.param.name); });

}  // namespace
}  // namespace fathom
