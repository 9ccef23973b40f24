#include "fathom/geometry/trajectory_file.hpp"

#include <cmath>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/random.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

using Trajectory = std::vector<StampedSpatialPose>;

// From before 1970 to now; rotations of any axis and angle, one by half a turn.
Trajectory drawn() {
  RandomStream random(1, "trajectory file");
  Trajectory trajectory;
  for (const std::int64_t time_ns : {-1'500'000'001LL, -1LL, 0LL, 999'999'999LL,
                                     1'403'636'579'763'555'527LL, 1'700'000'000'123'456'789LL}) {
    Eigen::Quaterniond q(random.normal(), random.normal(), random.normal(), random.normal());
    const Eigen::Vector3d p(1e3 * random.normal(), random.normal(), 1e-9 * random.normal());
    trajectory.push_back({time_ns, {p, q.normalized()}});
  }
  trajectory[2].pose.rotation = {0, 0, 1, 0};
  return trajectory;
}

class TrajectoryFile : public testing::Test {
 protected:
  SpatialTrajectory read(const std::string& content, std::optional<TrajectoryFormat> format = {}) {
    write_file(file_, content);
    return read_trajectory({file_, format, times_});
  }
  std::string error_of(const std::string& content, std::optional<TrajectoryFormat> format = {}) {
    const std::string message = input_error_of([&] { read(content, format); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    return message;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "trajectory";
  std::filesystem::path times_;
};

TEST_F(TrajectoryFile, TumAndEuRoCComeBackToTheSameBits) {
  const Trajectory written = drawn();
  std::string text = to_text(written, TrajectoryFormat::tum);
  for (const auto format : {TrajectoryFormat::euroc, TrajectoryFormat::tum}) {
    const SpatialTrajectory found = read(to_text(read(text).poses, format));
    text = to_text(found.poses, format);
    EXPECT_EQ(found.format, format);
    EXPECT_TRUE(found.has_times);
    ASSERT_EQ(found.poses.size(), written.size());
    for (std::size_t k = 0; k < written.size(); ++k) {
      EXPECT_EQ(found.poses[k].time_ns, written[k].time_ns);
      EXPECT_EQ(found.poses[k].pose.position_m, written[k].pose.position_m);
      EXPECT_EQ(found.poses[k].pose.rotation.coeffs(), written[k].pose.rotation.coeffs());
    }
  }
}

TEST_F(TrajectoryFile, KittiKeepsTheRotationAndTakesTimesFromAFile) {
  const Trajectory written = drawn();
  times_ = folder_ / "times.txt";
  write_file(times_, times_text(written));
  const SpatialTrajectory found = read(to_text(written, TrajectoryFormat::kitti));
  EXPECT_EQ(found.format, TrajectoryFormat::kitti);
  EXPECT_TRUE(found.has_times);
  ASSERT_EQ(found.poses.size(), written.size());
  for (std::size_t k = 0; k < written.size(); ++k) {
    EXPECT_EQ(found.poses[k].time_ns, written[k].time_ns);
    EXPECT_EQ(found.poses[k].pose.position_m, written[k].pose.position_m);
    EXPECT_LT(found.poses[k].pose.rotation.angularDistance(written[k].pose.rotation), 1e-15);
  }
}

TEST_F(TrajectoryFile, KittiOfAFewDigitsByHand) {
  // A quarter turn to the right of a camera (about y, down), after 2 m forward.
  const SpatialTrajectory found =
      read("1 0 0 0 0 1 0 0 0 0 1 0\n0.0001 0 1 0.5 0 1 0 -0.25 -1 0 0.0001 2\n");
  EXPECT_FALSE(found.has_times);
  ASSERT_EQ(found.poses.size(), 2U);
  EXPECT_EQ(found.poses[1].time_ns, 1'000'000'000);
  EXPECT_EQ(found.poses[1].pose.position_m, Eigen::Vector3d(0.5, -0.25, 2));
  const Eigen::Vector3d forward = found.poses[1].pose.rotation * Eigen::Vector3d::UnitZ();
  EXPECT_LT((forward - Eigen::Vector3d::UnitX()).norm(), 2e-4);
  EXPECT_EQ(read_kitti_poses(file_).size(), 2U);
}

TEST_F(TrajectoryFile, FurtherColumnsOfEuRoCAreCounted) {
  const auto found = read("#timestamp,...\n5000000000, 1, 2, 3, 1, 0, 0, 0, 9, 9, x\r\n");
  EXPECT_EQ(found.format, TrajectoryFormat::euroc);
  EXPECT_EQ(found.further_columns, 3U);
  EXPECT_EQ(found.poses[0].time_ns, 5'000'000'000);
  EXPECT_EQ(found.poses[0].pose.position_m, Eigen::Vector3d(1, 2, 3));
}

TEST_F(TrajectoryFile, RefusesWithFileAndLine) {
  const std::string tum = "0 0 0 0 0 0 0 1\n";
  const std::string euroc = "0,0,0,0,1,0,0,0\n";
  const std::string kitti = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  const std::vector<std::pair<std::string, std::string>> faults{
      {tum + "1,0,0,0,1,0,0,0", "got 1 field"},
      {tum + kitti, "expected 't x y z qx qy qz qw', got 12 fields"},
      {tum + "1403636579763555527 0 0 0 0 0 0 1", "it seems, nanoseconds"},
      {tum + "0 0 0 0 0 0 0 1", "time stamps must rise"},
      {tum + "0" + std::string(2 << 20, ' ') + "1", "has more than a mebibyte"},
      {euroc + "5000000000,0,0,0,1,0,0", "got 7 fields"},
      {euroc + tum, "got 1 field"},
      {euroc + "5000000000,0,0,,1,0,0,0", "'' is not a finite number"},
      {euroc + "5000000000,0,0,0,0,0,0,0", "must have length 1, not 0"},
      {euroc + "-5000000000,0,0,0,1,0,0,0", "time goes back from '0' to '-5000000000'"},
      {kitti + "1 0 0 0 0 1 0 0 0 0 1", "got 11 fields"},
      {kitti + "nan 0 0 0 0 1 0 0 0 0 1 0", "'nan' is not a finite number"},
      {kitti + "2 0 0 0 0 2 0 0 0 0 2 0", "must be a rotation matrix; its rows"},
      {kitti + "1 0 0 0 0.2 1 0 0 0 0 1 0", "must be a rotation matrix; its rows"},
      {kitti + "1 0 0 0 0 1 0 0 0 0 -1 0", "not a reflection"},
  };
  for (const auto& [content, expected] : faults) {
    EXPECT_THAT(error_of(content), AllOf(StartsWith(file_.string() + ":2: "), HasSubstr(expected)));
  }
  EXPECT_THAT(error_of(euroc + "1.5,0,0,0,1,0,0,0", TrajectoryFormat::euroc),
              HasSubstr(":2: the time stamp '1.5' is not in whole nanoseconds"));
  EXPECT_THAT(error_of("1 2 3\n"), HasSubstr("8 values (TUM), 12 (KITTI)"));
  EXPECT_THAT(error_of(tum, TrajectoryFormat::kitti), HasSubstr("got 8 fields"));
}

TEST_F(TrajectoryFile, SecondsAreNoNanoseconds) {
  const std::string seconds = "1403636579,0,0,0,1,0,0,0\n1403636580,1,0,0,1,0,0,0\n";
  EXPECT_THAT(error_of(seconds), HasSubstr("are 1 ns apart; an EuRoC file has whole nanoseconds"));
  // Whole seconds, several poses in each.
  EXPECT_THAT(error_of(seconds + "1403636580,2,0,0,1,0,0,0\n"), HasSubstr("whole nanoseconds"));
  EXPECT_THAT(error_of("-9223372036854775807,0,0,0,1,0,0,0\n9223372036854775807,0,0,0,1,0,0,0\n"),
              "(nothing thrown)");
}

TEST_F(TrajectoryFile, TimesMustFit) {
  const std::string kitti = "1 0 0 0 0 1 0 0 0 0 1 0\n";
  times_ = folder_ / "times.txt";
  const auto error_with = [&](const std::string& times) {
    write_file(times_, times);
    return error_of(kitti + kitti);
  };
  EXPECT_EQ(error_with("0.000000e+00\n1.036224e-01\n"), "(nothing thrown)");
  EXPECT_THAT(error_with("0\n"), HasSubstr("has 1 time stamps"));
  EXPECT_THAT(error_with("0\n0\n"), HasSubstr("times.txt:2: 2 poses have 1 time stamp"));
  EXPECT_THAT(error_with("0\nx\n"), HasSubstr("'x' is not a finite number"));
  EXPECT_THAT(error_with("0 1\n2 3\n"), HasSubstr("expected one time stamp"));
  EXPECT_THAT(error_of("0 0 0 0 0 0 0 1\n"), HasSubstr("has times of its own"));
}

TEST_F(TrajectoryFile, NothingInIt) {
  EXPECT_TRUE(read("").poses.empty());
  EXPECT_TRUE(read("# a comment\n\n").poses.empty());
  EXPECT_TRUE(read("", TrajectoryFormat::kitti).poses.empty());
  EXPECT_TRUE(read("#t\n", TrajectoryFormat::euroc).poses.empty());
}

}  // namespace
}  // namespace fathom
