// A camera that rolls and pitches: where its pixels meet the floor, and the way back.

#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>

#include "fathom/core/random.hpp"
#include "fathom/vision/camera.hpp"
#include "fathom/vision/features.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

CameraModel mounted_model() {
  CameraModel model;
  model.fx = 510.0;
  model.fy = 505.0;
  model.cx = 322.7;
  model.cy = 236.1;
  model.distortion = {-0.21, 0.06, 0.0011, -0.0007, -0.004};
  model.mount_x_m = 0.35;
  model.mount_y_m = -0.08;
  model.mount_yaw_rad = 0.7;
  return model;
}

Tilt drawn_tilt(RandomStream& random) {
  return {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3)};
}

Eigen::Vector2d drawn_pixel(RandomStream& random) {
  return {random.uniform(0, 639), random.uniform(0, 479)};
}

// The matrices written out once more: roll about x first, then pitch about y.
cv::Matx33d turned(const Tilt& tilt) {
  const double cr = std::cos(tilt.roll_rad), sr = std::sin(tilt.roll_rad);
  const double cp = std::cos(tilt.pitch_rad), sp = std::sin(tilt.pitch_rad);
  return cv::Matx33d(cp, 0, sp, 0, 1, 0, -sp, 0, cp) * cv::Matx33d(1, 0, 0, 0, cr, -sr, 0, sr, cr);
}

// A floor point in a picture by OpenCV, in three dimensions. The axes of the camera (right, down,
// away) are starboard, aft and down of the tilted body, turned by the mounting's yaw.
cv::Point2d projected(const CameraModel& m, const Eigen::Vector2d& point, const Stance& stance) {
  const double c = std::cos(m.mount_yaw_rad);
  const double s = std::sin(m.mount_yaw_rad);
  const cv::Matx33d level_from_camera =
      turned(stance.tilt) * cv::Matx33d(s, -c, 0, -c, -s, 0, 0, 0, -1);
  const cv::Vec3d place(m.mount_x_m, m.mount_y_m, stance.altitude_m);
  cv::Vec3d turn;
  cv::Rodrigues(level_from_camera.t(), turn);
  const cv::Mat intrinsics = (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), 0.0}}, turn,
                    -(level_from_camera.t() * place), intrinsics,
                    std::vector<double>(m.distortion.begin(), m.distortion.end()), pixels);
  return pixels.front();
}

TEST(TiltedCamera, TheOpticalAxisMeetsTheFloorByTheAngles) {
  CameraModel model;
  model.mount_x_m = 0.2;
  const Eigen::Vector2d axis(model.cx, model.cy);
  const Tilt tilt{0.13, -0.07};
  const Eigen::Vector2d expected(0.2 - 2.0 * std::tan(-0.07),
                                 2.0 * std::tan(0.13) / std::cos(-0.07));
  EXPECT_LT((Camera(model).floor_point(axis, {2.0, tilt}) - expected).norm(), 1e-12);
}

TEST(TiltedCamera, SeesWhatOpenCvProjects) {
  const Camera camera(mounted_model());
  RandomStream random(3, "tilted_camera");
  for (int i = 0; i < 500; ++i) {
    const Stance stance(random.uniform(0.5, 30), drawn_tilt(random));
    const Eigen::Vector2d pixel = drawn_pixel(random);
    const cv::Point2d seen = projected(camera.model(), camera.floor_point(pixel, stance), stance);
    EXPECT_LT((Eigen::Vector2d(seen.x, seen.y) - pixel).norm(), 1e-7) << pixel.transpose();
  }
}

TEST(TiltedCamera, PixelToFloorToPixel) {
  const Camera camera(mounted_model());
  RandomStream random(4, "tilted_camera");
  for (int i = 0; i < 500; ++i) {
    const Stance stance(random.uniform(0.5, 30), drawn_tilt(random));
    const Eigen::Vector2d pixel = drawn_pixel(random);
    const Eigen::Vector2d floor = camera.floor_point(pixel, stance);
    EXPECT_LT((camera.pixel(floor, stance) - pixel).norm(), 1e-8);
    EXPECT_EQ(camera.floor_points(std::vector{pixel}, stance).front(), floor);
  }
}

// To the last bit: what comes without attitude must not know of it.
TEST(TiltedCamera, WithoutTiltIsTheLevelOne) {
  const CameraModel model = mounted_model();
  const Camera camera(model);
  const MeasuredTilt level{{0.0, 0.0}, 0.01};
  RandomStream random(5, "tilted_camera");
  for (int i = 0; i < 100; ++i) {
    const double altitude_m = random.uniform(0.5, 30);
    const Eigen::Vector2d pixel = drawn_pixel(random);
    const Eigen::Vector2d floor = camera.floor_point(pixel, altitude_m);
    EXPECT_EQ(camera.floor_point(pixel, {altitude_m, level}), floor);
    EXPECT_EQ(camera.pixel(floor, {altitude_m, level}), camera.pixel(floor, altitude_m));
    const Camera::Neighbourhood near = camera.neighbourhood(pixel, 0.3, level.tilt);
    EXPECT_EQ(near.heading_rad, camera.heading(0.3));
    EXPECT_EQ(near.stretch, 1.0);
    // The tilted path at a tilt of next to nothing.
    EXPECT_LT((camera.floor_point(pixel, {altitude_m, Tilt{1e-12, -1e-12}}) - floor).norm(), 1e-9);
  }
}

// By central differences of floor_point itself, of a camera without distortion, as heading() leaves
// that out.
TEST(TiltedCamera, NeighbourhoodIsTheDerivative) {
  CameraModel model = mounted_model();
  model.distortion = {};
  const Camera camera(model);
  constexpr double kStep = 1e-4;
  RandomStream random(6, "tilted_camera");
  for (int i = 0; i < 100; ++i) {
    const Stance stance(2.0, drawn_tilt(random));
    const Eigen::Vector2d pixel = drawn_pixel(random);
    const auto difference = [&](const Eigen::Vector2d& way) -> Eigen::Vector2d {
      return (camera.floor_point(pixel + kStep * way, stance) -
              camera.floor_point(pixel - kStep * way, stance)) /
             (2.0 * kStep);
    };
    const double turn = random.uniform(-3, 3);
    const Eigen::Vector2d moved = difference({std::cos(turn), std::sin(turn)});
    const Camera::Neighbourhood near = camera.neighbourhood(pixel, turn, stance.tilt);
    EXPECT_NEAR(std::remainder(near.heading_rad - std::atan2(moved.y(), moved.x()), 2 * M_PI), 0.0,
                1e-7);
    Eigen::Matrix2d J;
    J << difference({1, 0}), difference({0, 1});
    const double level_m = metres_per_pixel(model, stance.altitude_m);
    EXPECT_NEAR(near.stretch, std::sqrt(std::abs(J.determinant())) / level_m, 1e-6);
  }
}

TEST(TiltedCamera, FeaturesHaveItsPointsSizesAndHeadings) {
  const Camera camera(mounted_model());
  const MeasuredTilt measured{{0.1, -0.2}, 0.002};
  Features features;
  features.pixels = {{100, 50}, {600, 400}};
  features.sizes_px = {8.0F, 12.0F};
  features.turns_rad = {0.5F, -2.0F};
  const FloorFeatures seen = on_floor(features, camera, 2.5, measured);
  for (std::size_t i = 0; i < 2; ++i) {
    const Camera::Neighbourhood near =
        camera.neighbourhood(features.pixels[i], features.turns_rad[i], measured.tilt);
    EXPECT_EQ(seen.points[i], camera.floor_point(features.pixels[i], {2.5, measured}));
    EXPECT_EQ(seen.headings_rad[i], near.heading_rad);
    EXPECT_NEAR(seen.sizes_m[i],
                metres_per_pixel(camera.model(), 2.5) * features.sizes_px[i] * near.stretch, 1e-12);
  }
  EXPECT_EQ(seen.viewpoint.pitch_rad, -0.2);
  EXPECT_EQ(seen.viewpoint.tilt_sigma_rad, 0.002);
  EXPECT_FALSE(on_floor(features, camera, 2.5).viewpoint.tilt_sigma_rad.has_value());
}

TEST(TiltedCamera, TheHorizonIsNoFloor) {
  const Camera camera;  // half of its width is seen under 32.6 degrees
  const double edge_rad = std::atan(320.0 / 500.0);
  const Stance steep(2.0, Tilt{M_PI / 2 - edge_rad + 0.01, 0.0});
  EXPECT_NE(test::input_error_of([&] { camera.footprint(steep); }).find("sees the horizon"),
            std::string::npos);
  EXPECT_NO_THROW(camera.footprint({2.0, Tilt{M_PI / 2 - edge_rad - 0.01, 0.0}}));
  EXPECT_TRUE(std::isnan(camera.floor_point({0.0, 240.0}, steep).x()));
  EXPECT_TRUE(camera.floor_point({600.0, 240.0}, steep).allFinite());
  // What is behind a camera that looks to port is in no picture, though a line leads there.
  EXPECT_TRUE(std::isnan(camera.pixel({0.0, -9.0}, {2.0, Tilt{1.4, 0.0}}).x()));
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    EXPECT_NE(test::input_error_of([&] {
                camera.floor_point({0, 0}, {2.0, Tilt{0.0, bad}});
              }).find("roll and pitch must be finite"),
              std::string::npos);
  }
}

// A net of floor points, each looked for in both pictures.
double counted_overlap(const Camera& camera, const Stance& a, const Stance& b, const Pose& motion) {
  const auto is_seen = [&](const Eigen::Vector2d& floor, const Stance& stance) {
    const Eigen::Vector2d p = camera.pixel(floor, stance);
    return p.x() >= -0.5 && p.x() < camera.model().width - 0.5 && p.y() >= -0.5 &&
           p.y() < camera.model().height - 0.5;
  };
  int in_a = 0, in_b = 0, in_both = 0;
  for (int i = -400; i < 400; ++i) {
    for (int k = -400; k < 400; ++k) {
      const Eigen::Vector2d floor(0.01 * i, 0.01 * k);
      const bool seen_a = is_seen(floor, a);
      const bool seen_b = is_seen(transform(inverse(motion), floor), b);
      in_a += seen_a;
      in_b += seen_b;
      in_both += seen_a && seen_b;
    }
  }
  return in_both / static_cast<double>(std::min(in_a, in_b));
}

TEST(TiltedCamera, OverlapIsThatOfWhatBothSee) {
  const Camera camera;
  const Stance port(2.0, Tilt{0.25, 0.05});
  const Stance aft(1.6, Tilt{-0.1, 0.2});
  for (const Pose& motion : {Pose{0.3, 0.2, 0.4}, Pose{-0.5, 0.9, -2.0}}) {
    EXPECT_NEAR(footprint_overlap(camera, port, aft, motion),
                counted_overlap(camera, port, aft, motion), 0.005);
    EXPECT_GT(std::abs(footprint_overlap(camera, port, aft, motion) -
                       footprint_overlap(camera, 2.0, 1.6, motion)),
              0.02);
  }
}

}  // namespace
}  // namespace fathom
