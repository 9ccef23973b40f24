#include "fathom/geometry/plane.hpp"

#include <cmath>
#include <vector>

#include <Eigen/Geometry>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "support/input_error.hpp"
#include "support/numbers.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::kPi;
using Trajectory = std::vector<StampedSpatialPose>;
using Eigen::AngleAxisd;
using Eigen::Quaterniond;
using Eigen::Vector3d;

Quaterniond attitude(double yaw, double pitch, double roll) {
  return AngleAxisd(yaw, Vector3d::UnitZ()) * AngleAxisd(pitch, Vector3d::UnitY()) *
         AngleAxisd(roll, Vector3d::UnitX());
}

struct Level {
  Trajectory spatial;
  std::vector<Pose> planar;
};

// Poses at any heading, level at height 4 m.
Level level(std::size_t count) {
  RandomStream random(5, "plane");
  Level drawn;
  for (std::size_t k = 0; k < count; ++k) {
    const Pose pose = test::random_pose(random, 10.0);
    drawn.planar.push_back(pose);
    drawn.spatial.push_back(
        {static_cast<std::int64_t>(k), {{pose.x, pose.y, 4.0}, attitude(pose.theta, 0, 0)}});
  }
  return drawn;
}

Projection projected(const Trajectory& trajectory, Plane plane) {
  const PlaneAxes axes = axes_of(plane, trajectory);
  return project(trajectory, axes, body_axes(trajectory, axes));
}

void expect_poses(const Projection& projection, const std::vector<Pose>& expected,
                  double tolerance = 1e-12) {
  ASSERT_EQ(projection.trajectory.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) {
    EXPECT_LE(test::distance(projection.trajectory[k].pose, expected[k]), tolerance) << k;
  }
}

// The world and the body both in other axes: what they do is the same.
Trajectory in_axes(const Trajectory& trajectory, const Eigen::Matrix3d& to) {
  Trajectory turned = trajectory;
  const Quaterniond q(to);
  for (auto& [time, pose] : turned) {
    pose.position_m = to * pose.position_m;
    pose.rotation = q * pose.rotation * q.conjugate();
  }
  return turned;
}

TEST(PlaneTest, LevelPosesLoseNothing) {
  const Level drawn = level(20);
  const Projection projection = projected(drawn.spatial, Plane::xy);
  expect_poses(projection, drawn.planar);
  EXPECT_LT(projection.loss.height_max_m, 1e-12);
  EXPECT_LT(projection.loss.roll_rms_rad + projection.loss.pitch_rms_rad, 1e-12);
  EXPECT_EQ(projection.loss.open_headings, 0U);
  EXPECT_FALSE(projection.loss.better);
  EXPECT_EQ(projection.heights_m[3], 4.0);
}

TEST(PlaneTest, AxesOfACameraAndOfAVehicleGiveTheSame) {
  const Level drawn = level(20);
  Eigen::Matrix3d camera;  // right, down, forward of forward, left, up
  camera << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  Eigen::Matrix3d third;  // up, forward, left
  third << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  expect_poses(projected(in_axes(drawn.spatial, camera), Plane::xz), drawn.planar);
  expect_poses(projected(in_axes(drawn.spatial, third), Plane::yz), drawn.planar);
  EXPECT_EQ(usual_plane(TrajectoryFormat::kitti), Plane::xz);
  EXPECT_EQ(usual_plane(TrajectoryFormat::euroc), Plane::xy);
}

TEST(PlaneTest, SaysWhatIsLost) {
  // Heights -1 and 1 about 7; angles by hand.
  Trajectory trajectory;
  for (int k = 0; k < 4; ++k) {
    const double sign = k % 2 == 0 ? 1.0 : -1.0;
    trajectory.push_back(
        {k, {{20.0 * k, 5.0 * k * k, 7.0 + sign}, attitude(0.3 * k, 0.1 * sign, 0.2 * sign)}});
  }
  const Projection projection = projected(trajectory, Plane::xy);
  EXPECT_NEAR(projection.loss.height_rms_m, 1.0, 1e-12);
  EXPECT_NEAR(projection.loss.height_max_m, 1.0, 1e-12);
  EXPECT_NEAR(projection.loss.pitch_rms_rad, 0.1, 1e-12);
  EXPECT_NEAR(projection.loss.roll_rms_rad, 0.2, 1e-12);
  for (int k = 0; k < 4; ++k) {
    EXPECT_NEAR(projection.trajectory[static_cast<std::size_t>(k)].pose.theta, 0.3 * k, 1e-12);
  }
}

TEST(PlaneTest, NearGimbalLockHeadingIsThatOfAnotherAxisOrSaidToBeOpen) {
  // A body whose x axis points up, as that of EuRoC, and whose z axis is its front.
  const Quaterniond mount(AngleAxisd(-kPi / 2, Vector3d::UnitY()));
  ASSERT_LT((mount * Vector3d::UnitX() - Vector3d::UnitZ()).norm(), 1e-12);
  Level drawn = level(20);
  for (auto& [time, pose] : drawn.spatial) pose.rotation = pose.rotation * mount;
  const Projection projection = projected(drawn.spatial, Plane::xy);
  // Its z axis is −x of the level body: half a turn on.
  std::vector<Pose> expected = drawn.planar;
  for (Pose& pose : expected) pose.theta = wrap_angle(pose.theta + kPi);
  expect_poses(projection, expected);
  EXPECT_EQ(projection.loss.open_headings, 0U);
  EXPECT_LT(projection.loss.roll_rms_rad + projection.loss.pitch_rms_rad, 1e-12);
  // One steep dive among level poses.
  Level dive = level(20);
  dive.spatial[7].pose.rotation = attitude(0.4, kPi / 2 - 0.01, 0);
  EXPECT_EQ(projected(dive.spatial, Plane::xy).loss.open_headings, 1U);
  dive.spatial[7].pose.rotation = attitude(0.4, kPi / 2, 0);
  EXPECT_TRUE(is_finite(projected(dive.spatial, Plane::xy).trajectory[7].pose));
}

TEST(PlaneTest, FitFindsATiltedPlane) {
  // Whichever way the normal comes out of the decomposition, up stays up.
  for (const double azimuth : {0.3, 1.5, 2.5, 4.0, 5.5}) {
    const Quaterniond tilt(AngleAxisd(0.2, Vector3d(std::cos(azimuth), std::sin(azimuth), 0)));
    Level drawn = level(30);
    for (auto& [time, pose] : drawn.spatial) {
      pose.position_m = tilt * pose.position_m;
      pose.rotation = tilt * pose.rotation;
    }
    const PlaneAxes axes = axes_of(Plane::fit, drawn.spatial);
    EXPECT_EQ(axes.named, Plane::xy);
    EXPECT_NEAR(axes.tilt_rad, 0.2, 1e-12);
    const Projection projection = projected(drawn.spatial, Plane::fit);
    EXPECT_LT(projection.loss.height_max_m, 1e-12);
    // The smallest rotation undoes the tilt, so that the poses are those of before.
    expect_poses(projection, drawn.planar, 1e-11);
    EXPECT_GT(projected(drawn.spatial, Plane::xy).loss.height_rms_m, 0.5);
  }
}

// Half way between xy and xz each plane alone would choose another side to be seen from.
TEST(PlaneTest, FitTakesTheSideOfAnotherOne) {
  for (const double angle : {0.24 * kPi, 0.26 * kPi}) {
    const Quaterniond tilt(AngleAxisd(angle, Vector3d::UnitX()));
    Level drawn = level(30);
    for (auto& [time, pose] : drawn.spatial) pose.position_m = tilt * pose.position_m;
    const Plane alone = axes_of(Plane::fit, drawn.spatial).named;
    EXPECT_EQ(alone, angle < 0.25 * kPi ? Plane::xy : Plane::xz);
    EXPECT_EQ(axes_of(Plane::fit, drawn.spatial, Plane::xy).named, Plane::xy);
    // A plane far from that one keeps its own.
    EXPECT_EQ(axes_of(Plane::fit, drawn.spatial, Plane::yz).named, alone);
  }
}

TEST(PlaneTest, FitOfALineIsRefused) {
  Trajectory line;
  for (int k = 0; k < 5; ++k) line.push_back({k, {{2.0 * k, -k * 1.0, 0.5 * k}, {1, 0, 0, 0}}});
  for (const Trajectory& trajectory : {line, Trajectory(1), Trajectory{}}) {
    EXPECT_THAT(test::input_error_of([&] { axes_of(Plane::fit, trajectory); }),
                testing::HasSubstr("lie on a line"));
  }
}

TEST(PlaneTest, NamesTheBetterPlane) {
  const Level drawn = level(30);
  Eigen::Matrix3d camera;
  camera << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  const Trajectory of_camera = in_axes(drawn.spatial, camera);
  EXPECT_EQ(projected(of_camera, Plane::xy).loss.better, Plane::xz);
  EXPECT_FALSE(projected(of_camera, Plane::xz).loss.better);
  // A transect that heaves more than it weaves is still one over a floor.
  Trajectory transect;
  for (int k = 0; k < 50; ++k) {
    transect.push_back({k, {{1.0 * k, 0.05 * std::sin(k), 0.5 * std::cos(k)}, {1, 0, 0, 0}}});
  }
  EXPECT_FALSE(projected(transect, Plane::xy).loss.better);
}

TEST(PlaneTest, BackInSpace) {
  const Level drawn = level(5);
  const Projection projection = projected(drawn.spatial, Plane::xy);
  const Trajectory back = to_space(projection.trajectory);
  expect_poses(projected(back, Plane::xy), drawn.planar);
  EXPECT_EQ(back[2].pose.position_m.z(), 0.0);
  EXPECT_EQ(back[2].time_ns, 2);
}

TEST(PlaneTest, OfNothing) {
  const Projection projection = projected({}, Plane::xy);
  EXPECT_TRUE(projection.trajectory.empty());
  EXPECT_EQ(projection.loss.height_rms_m, 0.0);
}

}  // namespace
}  // namespace fathom
