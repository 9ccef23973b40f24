// Tilts and reliefs: where points of the floor come to lie in a picture.

#include "src/datasets/simulated/attitude.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "flat_world.hpp"
#include "src/datasets/simulated/height_field.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::dot_in;
using test::dot_world;
using test::renderer_of;

constexpr double kAltitudeM = 2.0;
const Eigen::Vector2d kMiddle(319.5, 239.5);

TEST(Attitude, OneSigmaForBothIsThatOfEach) {
  AttitudeOptions each;
  each.roll_sigma_rad = each.pitch_sigma_rad = 0.02;
  AttitudeOptions both;
  both.both_sigma_rad = 0.02;
  EXPECT_EQ(draw_attitude(both, 20, 0.2, 5), draw_attitude(each, 20, 0.2, 5));
  EXPECT_FALSE(both.is_level());
  both.both_sigma_rad = 0.0;
  EXPECT_TRUE(both.is_level());
}

// Positive roll looks to port (y), positive pitch aft (−x), each by altitude · tan.
TEST(Tilt, MovesTheMiddleOfThePicture) {
  const double moved_m = kAltitudeM * std::tan(0.1);
  const FloorRenderer port = renderer_of(dot_world({0.0, moved_m}));
  EXPECT_LT((dot_in(port.render({{}, kAltitudeM, {0.1, 0.0}})) - kMiddle).norm(), 0.1);
  const FloorRenderer aft = renderer_of(dot_world({-moved_m, 0.0}));
  EXPECT_LT((dot_in(aft.render({{}, kAltitudeM, {0.0, 0.1}})) - kMiddle).norm(), 0.1);
}

// The picture of a point by the matrices themselves: into the axes of the tilted body, then
// through the pinhole. Roll before pitch, both about the body's axes.
TEST(Tilt, IsARotationOfTheCameraAboutItsCentre) {
  const double roll = 0.12, pitch = -0.07, heading = 0.5;
  const Eigen::Vector2d dot(0.6, 0.3);
  const FloorRenderer renderer = renderer_of(dot_world(dot));
  const Pose pose{0.1, -0.05, heading};
  Eigen::Matrix3d about_x, about_y, about_z;
  about_x << 1, 0, 0, 0, std::cos(roll), -std::sin(roll), 0, std::sin(roll), std::cos(roll);
  about_y << std::cos(pitch), 0, std::sin(pitch), 0, 1, 0, -std::sin(pitch), 0, std::cos(pitch);
  about_z << std::cos(heading), -std::sin(heading), 0, std::sin(heading), std::cos(heading), 0, 0,
      0, 1;
  const Eigen::Vector3d from_camera(dot.x() - pose.x, dot.y() - pose.y, -kAltitudeM);
  const Eigen::Vector3d in_body = (about_z * about_y * about_x).transpose() * from_camera;
  const Eigen::Vector2d expected(319.5 - 500 * in_body.y() / -in_body.z(),
                                 239.5 - 500 * in_body.x() / -in_body.z());
  const cv::Mat picture = renderer.render({pose, kAltitudeM, {roll, pitch}});
  EXPECT_LT((dot_in(picture) - expected).norm(), 0.15);
}

TEST(Tilt, IsPartOfWhatIsSeen) {
  const ViewRays rays{Camera()};
  const Eigen::AlignedBox2d level = rays.seen({}, kAltitudeM);
  const Eigen::AlignedBox2d rolled = rays.seen({}, kAltitudeM, {0.1, 0.0});
  const double edge_rad = std::atan(320.0 / 500);
  EXPECT_NEAR(level.max().y(), kAltitudeM * std::tan(edge_rad), 1e-9);
  EXPECT_NEAR(rolled.max().y(), kAltitudeM * std::tan(edge_rad + 0.1), 1e-9);
  EXPECT_NEAR(rolled.min().y(), -kAltitudeM * std::tan(edge_rad - 0.1), 1e-9);
  EXPECT_NE(test::input_error_of([&] {
              rays.seen({}, kAltitudeM, {1.1, 0.0});
            }).find("horizon"),
            std::string::npos);
}

// A raised plane is a nearer one: r metres from the middle is seen at f r / (a − h).
TEST(Relief, ARaisedFloorIsSeenFromNearer) {
  const Eigen::Vector2d dot(0.5, -0.6);
  World world = dot_world(dot);
  world.relief.heights_m = cv::Mat_<float>(2, 2, 0.1F);
  world.relief.metres_per_cell = 1.0;
  const cv::Mat picture = renderer_of(world).render({{}, kAltitudeM});
  const Eigen::Vector2d expected(319.5 + 500 * 0.6 / 1.9, 239.5 - 500 * 0.5 / 1.9);
  EXPECT_LT((dot_in(picture) - expected).norm(), 0.1);
}

// A slope, z = 0.2 x: the dot lies at a height of its own.
TEST(Relief, ASlopeIsMetWhereTheRayMeetsIt) {
  const Eigen::Vector2d dot(0.5, -0.6);
  World world = dot_world(dot);
  world.relief.heights_m = cv::Mat_<float>(2, 2);
  world.relief.heights_m.row(0) = 0.6F;
  world.relief.heights_m.row(1) = -0.6F;
  world.relief.metres_per_cell = 6.0;
  world.relief.first_m = {3.0, 3.0};
  const Tilt tilt{0.0, -0.05};
  const cv::Mat picture = renderer_of(world).render({{}, kAltitudeM, tilt});
  const Eigen::Vector3d in_body = tilt.rotation().transpose() * Eigen::Vector3d(0.5, -0.6, 0.1 - 2);
  const Eigen::Vector2d expected(319.5 - 500 * in_body.y() / -in_body.z(),
                                 239.5 - 500 * in_body.x() / -in_body.z());
  EXPECT_LT((dot_in(picture) - expected).norm(), 0.15);
}

TEST(Relief, HasItsHeightAndNoMeanAndSlopesWellBelowOne) {
  const Eigen::AlignedBox2d box(Eigen::Vector2d(-4, -5), Eigen::Vector2d(4, 5));
  const HeightField field = draw_relief(box, 0.1, 3);
  EXPECT_NEAR(cv::norm(field.heights_m, cv::NORM_INF), 0.1, 1e-6);
  EXPECT_NEAR(cv::mean(field.heights_m)[0], 0.0, 1e-6);
  cv::Scalar mean, sigma;
  cv::meanStdDev(field.heights_m, mean, sigma);
  EXPECT_GT(sigma[0], 0.02);
  double steepest = 0.0;
  for (int row = 1; row < field.heights_m.rows; ++row) {
    for (int column = 1; column < field.heights_m.cols; ++column) {
      const float here = field.heights_m(row, column);
      steepest = std::max({steepest, std::abs(here - field.heights_m(row - 1, column)) / 0.02,
                           std::abs(here - field.heights_m(row, column - 1)) / 0.02});
    }
  }
  EXPECT_GT(steepest, 0.1);
  EXPECT_LT(steepest, 0.6);
  EXPECT_EQ(field.at({4.0F, 5.0F}), field.heights_m(0, 0));
  EXPECT_NEAR(field.at({3.98F, 4.94F}), field.heights_m(1, 3), 1e-5);
  EXPECT_EQ(cv::norm(field.heights_m, draw_relief(box, 0.1, 3).heights_m, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(field.heights_m, draw_relief(box, 0.1, 4).heights_m, cv::NORM_INF), 0.05);
}

TEST(Attitude, IsAStationaryGaussMarkovProcess) {
  AttitudeOptions options;
  options.roll_sigma_rad = 0.03;
  options.pitch_sigma_rad = 0.06;
  options.correlation_time_s = 2.0;
  const auto tilts = draw_attitude(options, 40000, 0.5, 7);
  double roll = 0, pitch = 0, next = 0, cross = 0;
  for (std::size_t i = 0; i + 1 < tilts.size(); ++i) {
    roll += tilts[i].roll_rad * tilts[i].roll_rad / 4e4;
    pitch += tilts[i].pitch_rad * tilts[i].pitch_rad / 4e4;
    next += tilts[i].roll_rad * tilts[i + 1].roll_rad / 4e4;
    cross += tilts[i].roll_rad * tilts[i].pitch_rad / 4e4;
  }
  // Some 40000 · 0.5 / 2 / 2 independent samples: 1.5 % of a variance is a standard deviation.
  EXPECT_NEAR(std::sqrt(roll), 0.03, 0.03 * 0.03);
  EXPECT_NEAR(std::sqrt(pitch), 0.06, 0.06 * 0.03);
  EXPECT_NEAR(next / roll, std::exp(-0.25), 0.02);
  EXPECT_NEAR(cross / std::sqrt(roll * pitch), 0.0, 0.05);
  // The first one has the same spread: it does not start level.
  double first = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    const double value = draw_attitude(options, 1, 0.5, seed).front().roll_rad;
    first += value * value / 400;
  }
  EXPECT_NEAR(std::sqrt(first), 0.03, 0.004);
}

TEST(Attitude, LevelByDefault) {
  for (const Tilt& tilt : draw_attitude({}, 3, 0.5, 1)) EXPECT_TRUE(tilt.is_level());
}

}  // namespace
}  // namespace fathom
