// Rows of odometry0 that jump out and back, and odometry that starts again.

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/sensor_summary.hpp"
#include "folder_fixture.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr std::int64_t kRowInterval_ns = 1'000'000'000;

/// A row of odometry every second from 0 to 40 s; pictures at 0, 20 and 40 s.
struct OdometryOf {
  std::vector<Pose> poses = std::vector<Pose>(41);
  std::string yaml;
  OdometryGaps gaps = {};

  ImageFolder folder() const {
    FolderFixture fixture;
    fixture.files.erase("state_groundtruth_estimate0/data.csv");
    const auto stamp = [](std::size_t s) {
      return std::to_string(kRowInterval_ns * std::int64_t(s));
    };
    fixture.files["cam0/data.csv"] = "0,a.png\n" + stamp(20) + ",b.png\n" + stamp(40) + ",c.png\n";
    std::string altitudes, rows;
    for (std::size_t i = 0; i < poses.size(); ++i) {
      altitudes += stamp(i) + ",2\n";
      rows += stamp(i) + "," + std::to_string(poses[i].x) + "," + std::to_string(poses[i].y) + "," +
              std::to_string(poses[i].theta) + ",0.0001,0.0001,0.0001\n";
    }
    fixture.files["altimeter0/data.csv"] = altitudes;
    fixture.files["odometry0/data.csv"] = rows;
    if (!yaml.empty()) fixture.files["odometry0/sensor.yaml"] = yaml;
    return ImageFolder(fixture.write(), gaps);
  }
};

OdometryOf ahead() {
  OdometryOf odometry;
  for (std::size_t i = 0; i < odometry.poses.size(); ++i) {
    odometry.poses[i] = {0.4 * static_cast<double>(i), 1.0, 0.0};
  }
  return odometry;
}

// From row `first` on as if odometry had started there, at `start`.
void start_again(OdometryOf& odometry, std::size_t first, const Pose& start = {}) {
  const Pose before = odometry.poses[first];
  for (std::size_t i = first; i < odometry.poses.size(); ++i) {
    odometry.poses[i] = compose(start, between(before, odometry.poses[i]));
  }
}

TEST(OdometryFaults, WhereItStartsAgainThereIsAHole) {
  OdometryOf odometry = ahead();
  start_again(odometry, 30);
  const ImageFolder folder = odometry.folder();
  EXPECT_FALSE(folder.info(1).is_hole);
  EXPECT_TRUE(folder.info(2).is_hole);
  // Nineteen steps of 0.4 m, and nothing over the hole: in one second 2 m either way.
  EXPECT_NEAR(folder.info(2).motion->mean.position().norm(), 19 * 0.4, 1e-5);
  EXPECT_NEAR(folder.info(2).motion->covariance(0, 0), 4.0 + 19 * 1e-4, 1e-6);
  EXPECT_THAT(
      folder.remarks(),
      ElementsAre(AllOf(HasSubstr("odometry0 starts again at line 31 (t = 30000000000 ns), "),
                        HasSubstr(" m away: the motion there is a hole"))));
  // It is no outlier of a row that could be kept.
  odometry.yaml = "outliers: keep\n";
  EXPECT_TRUE(odometry.folder().info(2).is_hole);
  EXPECT_EQ(odometry.folder().remarks(), folder.remarks());
}

TEST(OdometryFaults, TheHoleIsAsDeclared) {
  OdometryOf odometry;
  for (std::size_t i = 0; i < 41; ++i) odometry.poses[i].x = i < 20 ? 0.4 * double(i) : 500.0;
  odometry.gaps.declared.sigma_m = 3.0;
  odometry.gaps.declared.sigma_rad = 0.5;
  const ImageFolder folder = odometry.folder();
  ASSERT_TRUE(folder.info(1).is_hole);
  EXPECT_NEAR(folder.info(1).motion->mean.x, 19 * 0.4, 1e-6);
  EXPECT_NEAR(folder.info(1).motion->covariance(0, 0), 9.0 + 19 * 1e-4, 1e-9);
  EXPECT_NEAR(folder.info(1).motion->covariance(2, 2), 0.25 + 19 * 1e-4, 1e-9);
}

TEST(OdometryFaults, SeveralStartsAreSeveralHoles) {
  OdometryOf odometry = ahead();
  start_again(odometry, 15);
  start_again(odometry, 33, {80.0, -20.0, 2.0});
  const ImageFolder folder = odometry.folder();
  EXPECT_TRUE(folder.info(1).is_hole);
  EXPECT_TRUE(folder.info(2).is_hole);
  EXPECT_THAT(folder.remarks(), ElementsAre(HasSubstr("line 16 "), HasSubstr("line 34 ")));
}

// By 0.9 m in a second no vehicle is too fast; but to where it began, to the millimetre, it is not
// carried.
TEST(OdometryFaults, NearTheStartThePoseItselfTells) {
  OdometryOf odometry;
  for (std::size_t i = 0; i < 41; ++i) {
    const double angle = 0.15 * static_cast<double>(i);
    odometry.poses[i] = {0.9 * std::sin(angle), 0.9 - 0.9 * std::cos(angle), angle};
  }
  start_again(odometry, 25);
  EXPECT_TRUE(odometry.folder().info(2).is_hole);
  OdometryOf early = ahead();
  start_again(early, 4, early.poses[0]);
  EXPECT_TRUE(early.folder().info(1).is_hole);
}

// `check` says that odometry stops where a key would make a hole, and this is none of those.
TEST(OdometryFaults, ACheckTellsThemFromGaps) {
  OdometryOf odometry = ahead();
  start_again(odometry, 30);
  const ImageFolder plain = odometry.folder();
  odometry.gaps.least_intervals = 5.0;
  const ImageFolder with_gaps = odometry.folder();
  FolderSummary summary;
  sum_up_holes(with_gaps, &plain, summary);
  EXPECT_THAT(summary.facts, ElementsAre(HasSubstr("odometry: 1 hole")));
  EXPECT_THAT(summary.warnings, IsEmpty());
}

TEST(OdometryFaults, ARowThatJumpsOutAndBackIsMoved) {
  OdometryOf odometry = ahead();
  odometry.poses[20] = {300.0, -7.0, 2.0};
  odometry.poses[31] = {-300.0, -7.0, 2.0};
  const ImageFolder folder = odometry.folder();
  EXPECT_FALSE(folder.info(1).is_hole);
  EXPECT_NEAR(folder.info(1).motion->mean.position().norm(), 8.0, 1e-5);
  EXPECT_NEAR(folder.info(2).motion->mean.position().norm(), 8.0, 1e-5);
  EXPECT_NEAR(folder.info(1).motion->mean.theta, 0.0, 1e-9);
  EXPECT_THAT(folder.remarks(),
              ElementsAre(HasSubstr("odometry0: 2 of 41 readings left out (first: line 21, 293 m "
                                    "from the row before, and back)")));
}

TEST(OdometryFaults, WhatAVehicleDoesIsNone) {
  OdometryOf rests = ahead();  // and then moves, by 3 m a second
  for (std::size_t i = 0; i < 41; ++i) rests.poses[i].x = i < 36 ? 0.0 : 3.0 * double(i - 35);
  EXPECT_THAT(rests.folder().remarks(), IsEmpty());
  for (std::size_t i = 0; i < 41; ++i) rests.poses[i].x = i < 38 ? 0.0 : 3.0 * double(i - 37);
  EXPECT_THAT(rests.folder().remarks(), IsEmpty());
  OdometryOf hops = ahead();  // from place to place
  for (std::size_t i = 0; i < 41; ++i) hops.poses[i].x = 1.5 * double(i / 10);
  EXPECT_THAT(hops.folder().remarks(), IsEmpty());
  OdometryOf fast = ahead();
  for (std::size_t i = 0; i < 41; ++i) fast.poses[i].x = 20.0 * double(i);
  EXPECT_THAT(fast.folder().remarks(), IsEmpty());
  OdometryOf square;  // exactly back to where it was, by right angles
  for (std::size_t i = 0; i < 41; ++i) {
    const double side = double(i % 10);
    const Pose corners[] = {
        {side, 0, 0}, {10, side, M_PI_2}, {10 - side, 10, M_PI}, {0, 10 - side, -M_PI_2}};
    square.poses[i] = corners[i / 10 % 4];
  }
  EXPECT_THAT(square.folder().remarks(), IsEmpty());
}

// Headings that are degrees turn the steps every way, but no longer.
TEST(OdometryFaults, ManyJumpsAreNoFaultsOfRows) {
  OdometryOf degrees = ahead();
  for (std::size_t i = 0; i < 41; ++i) degrees.poses[i].theta = 2.3 * double(i % 9);
  EXPECT_THAT(degrees.folder().remarks(), IsEmpty());
  OdometryOf scattered = ahead();
  for (const std::size_t i : {3, 9, 15, 21, 27, 33}) scattered.poses[i].y = 90.0;
  EXPECT_THAT(scattered.folder().remarks(), IsEmpty());
}

}  // namespace
}  // namespace fathom
