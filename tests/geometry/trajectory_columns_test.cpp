// How the columns of a trajectory are parted, and in which order they are.

#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/geometry/trajectory_file.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::StartsWith;

class TrajectoryColumns : public testing::Test {
 protected:
  SpatialTrajectory read(const std::string& content, std::optional<TrajectoryFormat> format = {}) {
    write_file(file_, content);
    return read_trajectory({file_, format, {}});
  }
  std::string error_of(const std::string& content, std::optional<TrajectoryFormat> format = {}) {
    return input_error_of([&] { read(content, format); });
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "trajectory";
};

TEST_F(TrajectoryColumns, TumWithCommas) {
  const std::string text =
      "# t,x,y,z,qx,qy,qz,qw\n"
      "1403636579,1,2,3,0,0,0.6,0.8\n"
      "1403636579.763555527, 1.5, 2, 3, 0, 0, 0.8, 0.6\n";
  for (const std::optional<TrajectoryFormat> format :
       {std::optional<TrajectoryFormat>{}, std::optional{TrajectoryFormat::tum}}) {
    const SpatialTrajectory found = read(text, format);
    EXPECT_EQ(found.format, TrajectoryFormat::tum);
    ASSERT_EQ(found.poses.size(), 2U);
    EXPECT_EQ(found.poses[1].time_ns, 1'403'636'579'763'555'527);
    EXPECT_EQ(found.poses[1].pose.position_m, Eigen::Vector3d(1.5, 2, 3));
    EXPECT_EQ(found.poses[1].pose.rotation.coeffs(), Eigen::Vector4d(0, 0, 0.8, 0.6));
  }
  EXPECT_THAT(error_of(text + "1403636580 0 0 0 0 0 0 1\n"), HasSubstr("got 1 field"));
  // Whole seconds could be of either format, and a flag says which.
  const std::string whole = "1403636579,1,2,3,0,0,0.6,0.8\n1403636580,1,2,3,0,0,0.6,0.8\n";
  EXPECT_THAT(error_of(whole), HasSubstr("--from tum reads commas, seconds"));
  EXPECT_EQ(read(whole, TrajectoryFormat::tum).poses[1].time_ns, 1'403'636'580'000'000'000);
}

TEST_F(TrajectoryColumns, DecimalCommasAreNamed) {
  for (const std::string row :
       {"0,5 1,0 2,0 0,0 0 0 0 1", "0,5\t1,0\t2,0\t0\t0\t0\t0\t1", "0,5;1,0;2,0;0,0;0;0;0;1",
        "0,5,1,0,2,0,0,0,0,0,0,0,0,0,1,0", "0 1,0 2,0 0 0 0 0 1"}) {
    for (const std::optional<TrajectoryFormat> format :
         {std::optional<TrajectoryFormat>{}, std::optional{TrajectoryFormat::tum},
          std::optional{TrajectoryFormat::euroc}}) {
      EXPECT_THAT(
          error_of("# t\n" + row + "\n", format),
          AllOf(StartsWith(file_.string() + ":2: "), HasSubstr("decimal commas? expected points")));
    }
  }
  EXPECT_THAT(error_of("0 0 0 0 0 0 0 1\n0,05 0 0 0 0 0 0 1\n"),
              AllOf(StartsWith(file_.string() + ":2: "), HasSubstr("decimal commas?")));
  EXPECT_THAT(error_of("1 0 0 0,5 0 1 0 0 0 0 1 0\n"), HasSubstr("decimal commas?"));
}

TEST_F(TrajectoryColumns, WholeNanosecondsAsFloats) {
  const auto found = read(
      "1403636579763555584.0,0,0,0,1,0,0,0\n"
      "1.403636579863555527e+18,1,0,0,1,0,0,0\n"
      "+1.7e+18,2,0,0,1,0,0,0\n");
  EXPECT_EQ(found.format, TrajectoryFormat::euroc);
  ASSERT_EQ(found.poses.size(), 3U);
  EXPECT_EQ(found.poses[0].time_ns, 1'403'636'579'763'555'584);
  EXPECT_EQ(found.poses[1].time_ns, 1'403'636'579'863'555'527);
  EXPECT_EQ(found.poses[2].time_ns, 1'700'000'000'000'000'000);
  for (const std::string stamp : {"1403636579763555584.5", "1e19", "nan"}) {
    EXPECT_THAT(error_of("0,0,0,0,1,0,0,0\n" + stamp + ",0,0,0,1,0,0,0\n"),
                HasSubstr("'" + stamp + "' is not in whole nanoseconds"));
  }
}

// Round a circle, heading along it, at a depth that changes by a few centimetres.
std::string circle(const std::function<std::string(double half_heading)>& quaternion,
                   const std::string& stamp, char separator) {
  std::string text;
  for (int k = 0; k < 40; ++k) {
    const double angle = 0.15 * k;
    const double height = 0.02 * std::sin(3.0 * angle);
    text += fmt::format("{}{}{}{}{}{}{}{}{}\n", 100 + k, stamp, separator, 5.0 * std::sin(angle),
                        separator, -5.0 * std::cos(angle), separator, height,
                        separator + quaternion(angle / 2.0));
  }
  return text;
}

TEST_F(TrajectoryColumns, QuaternionsOfAnotherOrderAreNamed) {
  const auto w_first = [](const char* part) {
    return [part](double half) {
      return fmt::format("{}{}0.01{}-0.02{}{}", std::cos(half), part, part, part, std::sin(half));
    };
  };
  const auto w_last = [](const char* part) {
    return [part](double half) {
      return fmt::format("0.01{}-0.02{}{}{}{}", part, part, std::sin(half), part, std::cos(half));
    };
  };
  EXPECT_THAT(error_of(circle(w_first(" "), ".5", ' ')),
              AllOf(HasSubstr("its quaternions look like qw qx qy qz"),
                    HasSubstr("40 of 40 turn about z alone"),
                    HasSubstr("expected column 5 behind column 8")));
  EXPECT_EQ(error_of(circle(w_last(" "), ".5", ' ')), "(nothing thrown)");
  EXPECT_THAT(error_of(circle(w_last(","), "000000000", ',')),
              AllOf(HasSubstr("its quaternions look like qx qy qz qw"),
                    HasSubstr("expected column 8 before column 5")));
  EXPECT_EQ(error_of(circle(w_first(","), "000000000", ',')), "(nothing thrown)");
}

TEST_F(TrajectoryColumns, CamerasAndMotionInSpaceAreLeftAlone) {
  // A roll about x while it flies along y and z, as on the plane yz.
  std::string rolling;
  // A camera that looks down: half a turn about x, then the heading.
  std::string down;
  // One heading, half a turn about x: a body whose z is down.
  std::string straight;
  // A camera on the plane xz: a turn about y.
  std::string ahead;
  for (int k = 0; k < 40; ++k) {
    const double a = 0.15 * k;
    const double s = std::sin(a / 2.0);
    const double c = std::cos(a / 2.0);
    const double u = 5.0 * std::sin(a);
    const double v = 5.0 * std::cos(a);
    rolling += fmt::format("{} 0 {} {} {} 0 0 {}\n", k, u, v, s, c);
    down += fmt::format("{} {} {} 0 {} {} 0 0\n", k, u, v, c, s);
    straight += fmt::format("{} {} {} 0 1 0 0 0\n", k, u, v);
    ahead += fmt::format("{} {} 0 {} 0 {} 0 {}\n", k, u, v, s, c);
  }
  for (const std::string& text : {rolling, down, straight, ahead}) {
    EXPECT_EQ(error_of(text), "(nothing thrown)");
  }
}

}  // namespace
}  // namespace fathom
