#include "fathom/geometry/trajectory.hpp"

#include <cmath>
#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "support/data.hpp"
#include "support/input_error.hpp"
#include "support/numbers.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::kPi;
using testing::HasSubstr;

class Tum : public testing::Test {
 protected:
  std::vector<StampedPose> read(const std::string& content) {
    write_file(file_, content);
    return read_tum(file_);
  }
  std::string error_of(const std::string& content) {
    return input_error_of([&] { read(content); });
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "trajectory.tum";
};

TEST(Trajectory, ComposesMotionsFromTheOrigin) {
  RandomStream random(1, "trajectory");
  std::vector<Pose> motions;
  for (int i = 0; i < 20; ++i) motions.push_back(test::random_pose(random));
  const Pose origin{3, -2, 1.5};
  const std::vector<Pose> poses = compose_trajectory(origin, motions);
  ASSERT_EQ(poses.size(), 21U);
  Eigen::Matrix3d T = test::homogeneous(origin);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    EXPECT_LT(test::distance(poses[k], Pose::from_vector(test::t2v(T))), 1e-12);
    if (k < motions.size()) T = T * test::homogeneous(motions[k]);
  }
  EXPECT_THAT(compose_trajectory(origin, {}), testing::ElementsAre(origin));
}

TEST(Trajectory, PosesOfAView) {
  struct Three : TrajectoryView {
    std::size_t size() const override { return 3; }
    Pose pose(std::size_t k) const override { return {static_cast<double>(k), 0, 0}; }
  };
  EXPECT_THAT(poses_of(Three{}), testing::ElementsAre(Pose{0, 0, 0}, Pose{1, 0, 0}, Pose{2, 0, 0}));
}

TEST_F(Tum, ReadsBackWhatWasWritten) {
  RandomStream random(2, "tum");
  std::vector<StampedPose> written;
  // From before 1970 to now, and a heading at each end.
  for (const std::int64_t time : {-1'500'000'001LL, -1LL, 0LL, 1LL, 999'999'999LL, 3'000'000'000LL,
                                  1'403'636'579'763'555'527LL, 1'700'000'000'123'456'789LL}) {
    written.push_back({time, test::random_pose(random, 1e5)});
  }
  written[1].pose = {1.0 / 3.0, 1e-300, kPi};
  written[2].pose = {-0.0, 4e6, std::nextafter(-kPi, 0.0)};
  written[3].pose.theta = 1e-12;
  const std::vector<StampedPose> found = read(to_tum(written));
  ASSERT_EQ(found.size(), written.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    EXPECT_EQ(found[k].time_ns, written[k].time_ns);
    EXPECT_EQ(found[k].pose.x, written[k].pose.x);
    EXPECT_EQ(found[k].pose.y, written[k].pose.y);
    EXPECT_NEAR(test::angle_between(found[k].pose.theta, written[k].pose.theta), 0, 1e-15);
  }
}

TEST_F(Tum, WritesTheFormatOfTheDocumentation) {
  const std::vector<StampedPose> one{{1'500'000'000, {0.5, -2, 0}}};
  EXPECT_EQ(to_tum(one), "# t x y z qx qy qz qw\n1.500000000 0.5 -2 0 0 0 0 1\n");
}

TEST_F(Tum, UnderstandsWhatOthersWrite) {
  // Exponents, tabs, CRLF, comments, blank lines, −q for q, few digits, no newline at the end.
  const auto found = read(
      "# a comment\r\n"
      "\r\n"
      "1.403636579763555527e+09\t1 2 3 0 0 0.7071 0.7071\r\n"
      "+1403636580 1e0 2 3 0 0 -0.7071067811865476 -0.7071067811865476 # behind\r\n"
      "1403636581 1 2 3 0 0 1 0");
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].time_ns, 1'403'636'579'763'555'527LL);
  EXPECT_EQ(found[1].time_ns, 1'403'636'580'000'000'000LL);
  EXPECT_NEAR(found[0].pose.theta, kPi / 2, 1e-15);
  EXPECT_NEAR(found[1].pose.theta, kPi / 2, 1e-15);
  EXPECT_EQ(found[2].pose.theta, kPi);
}

TEST_F(Tum, HeadingIsTheYawOfTheQuaternion) {
  // Yaw 0.5, then pitch 0.3, then roll −0.2 (quaternion by the half-angle product formula).
  const auto quaternion = [](double yaw, double pitch, double roll) {
    const double cy = std::cos(yaw / 2), sy = std::sin(yaw / 2);
    const double cp = std::cos(pitch / 2), sp = std::sin(pitch / 2);
    const double cr = std::cos(roll / 2), sr = std::sin(roll / 2);
    return std::to_string(sr * cp * cy - cr * sp * sy) + " " +
           std::to_string(cr * sp * cy + sr * cp * sy) + " " +
           std::to_string(cr * cp * sy - sr * sp * cy) + " " +
           std::to_string(cr * cp * cy + sr * sp * sy);
  };
  EXPECT_NEAR(read("0 0 0 0 " + quaternion(0.5, 0.3, -0.2))[0].pose.theta, 0.5, 1e-5);
}

TEST_F(Tum, EmptyFileIsAnEmptyTrajectory) {
  EXPECT_TRUE(read("").empty());
  EXPECT_TRUE(read("# nothing\n\n").empty());
}

TEST_F(Tum, RefusesWithFileAndLine) {
  const std::string good = "# head\n1 0 0 0 0 0 0 1\n";
  const std::vector<std::pair<std::string, std::string>> faults{
      {"2 0 0 0 0 0 1", "got 7 fields"},
      {"2 0 0 0 0 0 0 1 9", "got 9 fields"},
      {"2 nan 0 0 0 0 0 1", "'nan' is not a finite number"},
      {"2 0 inf 0 0 0 0 1", "'inf' is not"},
      {"2 0 x 0 0 0 0 1", "'x' is not"},
      {"2 0 0 0 0 0 0 0", "length 1, not 0"},
      {"2 0 0 0 1e200 0 0 1", "length 1, not inf"},
      {"2 0 0 0 0 0 3 4", "length 1, not 5"},
      {"1403636579763555527 0 0 0 0 0 0 1", "not in seconds"},
      {"1 0 0 0 0 0 0 1", "must rise"},
      {"0.5 0 0 0 0 0 0 1", "time goes back from '1' to '0.5'"},
  };
  for (const auto& [line, expected] : faults) {
    const std::string message = error_of(good + line + "\n");
    EXPECT_THAT(message, testing::StartsWith(file_.string() + ":3: ")) << line;
    EXPECT_THAT(message, HasSubstr(expected)) << line;
    EXPECT_EQ(message.find('\n'), std::string::npos);
  }
}

TEST_F(Tum, RefusesWhatIsNoFile) {
  EXPECT_THAT(input_error_of([&] { read_tum(folder_ / "none.tum"); }), HasSubstr("none.tum"));
  EXPECT_THAT(input_error_of([&] { read_tum(folder_.path()); }), HasSubstr("is a folder"));
}

TEST_F(Tum, RealGroundTruth) {
  FATHOM_REQUIRE_DATA("pose_graphs/M3500.groundtruth.tum");
  const auto truth = read_tum(test::data_path("pose_graphs/M3500.groundtruth.tum"));
  ASSERT_EQ(truth.size(), 3500U);
  EXPECT_EQ(truth.back().time_ns, 3'499'000'000'000LL);
  EXPECT_EQ(truth.back().pose.x, -41);
  EXPECT_EQ(truth.back().pose.y, -36);
  EXPECT_NEAR(truth.back().pose.theta, 2 * std::atan2(0.707108079859, 0.707105482511), 1e-12);
}

TEST(GivenTrajectory, SaysWhatIsNew) {
  GivenTrajectory trajectory({{1, 2, 3}, {4, 5, 6}});
  const MovedPoses all = trajectory.moved_since(0);
  EXPECT_EQ(all.keyframes, (std::vector<std::size_t>{0, 1}));
  EXPECT_EQ(trajectory.moved_since(all.revision).keyframes, std::vector<std::size_t>{});
  trajectory.append({7, 8, 9});
  EXPECT_EQ(trajectory.moved_since(all.revision).keyframes, std::vector<std::size_t>{2});
}

}  // namespace
}  // namespace fathom
