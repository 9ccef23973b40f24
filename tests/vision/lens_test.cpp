// Lenses that are not radial-tangential: against OpenCV, and against numerical derivatives.

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <opencv2/calib3d.hpp>

#include "fathom/core/random.hpp"
#include "fathom/vision/camera.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;

struct Lens {
  const char* name;
  CameraModel model;
  double widest_rad;  ///< the angle from the axis that is seen furthest out
};

CameraModel lens_model(DistortionModel distortion_model, double focal_px,
                       const std::array<double, 8>& coefficients) {
  CameraModel model;
  model.fx = focal_px;
  model.fy = 0.98 * focal_px;
  model.cx = 322.7;
  model.cy = 236.1;
  model.distortion_model = distortion_model;
  model.distortion = coefficients;
  model.mount_x_m = 0.3;
  model.mount_yaw_rad = 0.7;
  return model;
}

std::vector<Lens> lenses() {
  constexpr auto kFisheye = DistortionModel::equidistant;
  constexpr auto kRational = DistortionModel::rational_polynomial;
  return {{"ideal fisheye", lens_model(kFisheye, 290, {}), 1.38},
          {"fisheye of a phone", lens_model(kFisheye, 310, {-0.013, 0.021, -0.016, 0.004}), 1.31},
          {"fisheye bent outwards", lens_model(kFisheye, 400, {0.35, 0.1, 0.02, 0.01}), 0.85},
          {"pinhole as fisheye", lens_model(kFisheye, 700, {0.333, 0.133, 0.054, 0.022}), 0.52},
          {"depth camera",
           lens_model(kRational, 455, {0.5, -2.6, 0.0007, -0.0004, 1.5, 0.39, -2.4, 1.43}), 0.74},
          {"wide rational",
           lens_model(kRational, 300, {5.2, 2.3, -0.0003, 0.0004, 0.08, 5.55, 3.9, 0.6}), 1.45},
          {"pinhole as rational", lens_model(kRational, 500, {}), 0.68}};
}

std::vector<cv::Point2d> pixel_net() {
  std::vector<cv::Point2d> pixels;
  for (double u = -0.5; u <= 639.5; u += 16.0) {
    for (double v = -0.5; v <= 479.5; v += 16.0) pixels.emplace_back(u, v);
  }
  return pixels;
}

cv::Mat lens_matrix(const CameraModel& m) {
  return (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
}

cv::Mat lens_coefficients(const CameraModel& m) {
  const int count = m.distortion_model == DistortionModel::equidistant ? 4 : 8;
  return cv::Mat(std::vector<double>(m.distortion.begin(), m.distortion.begin() + count), true);
}

// The lens without the mounting: floor points are image points but for the axes.
Camera unmounted(CameraModel model) {
  model.mount_x_m = model.mount_y_m = model.mount_yaw_rad = 0.0;
  return Camera(model);
}

cv::Point2d ideal(const Camera& camera, const cv::Point2d& pixel) {
  const Eigen::Vector2d floor = camera.floor_point({pixel.x, pixel.y}, 1.0);
  return {-floor.y(), -floor.x()};
}

TEST(Lens, EachPixelComesBackFromTheFloor) {
  for (const Lens& lens : lenses()) {
    const Camera camera(lens.model);
    double widest_rad = 0.0;
    for (const cv::Point2d& point : pixel_net()) {
      const Eigen::Vector2d pixel(point.x, point.y);
      const Eigen::Vector2d floor = camera.floor_point(pixel, 1.7);
      EXPECT_LT((camera.pixel(floor, 1.7) - pixel).norm(), 1e-6) << lens.name << ' ' << point;
      widest_rad =
          std::max(widest_rad, std::atan((floor - Eigen::Vector2d(0.3, 0.0)).norm() / 1.7));
      // Only a narrow one sees the floor with all of its picture.
      if (lens.widest_rad > 1.0) continue;
      const Stance tilted(1.7, Tilt{0.2, -0.1});
      EXPECT_LT((camera.pixel(camera.floor_point(pixel, tilted), tilted) - pixel).norm(), 1e-6);
    }
    EXPECT_NEAR(widest_rad, lens.widest_rad, 0.05) << lens.name;
  }
}

TEST(Lens, AgreesWithOpenCv) {
  const cv::TermCriteria exact(cv::TermCriteria::MAX_ITER + cv::TermCriteria::EPS, 500, 1e-14);
  for (const Lens& lens : lenses()) {
    const Camera camera = unmounted(lens.model);
    const cv::Mat K = lens_matrix(lens.model);
    const cv::Mat D = lens_coefficients(lens.model);
    const std::vector<cv::Point2d> pixels = pixel_net();
    std::vector<cv::Point2d> points;
    std::vector<cv::Point2d> back;
    if (lens.model.distortion_model == DistortionModel::equidistant) {
      cv::fisheye::undistortPoints(pixels, points, K, D, cv::noArray(), cv::noArray(), exact);
      cv::fisheye::distortPoints(points, back, K, D);
    } else {
      cv::undistortPoints(pixels, points, K, D, cv::noArray(), cv::noArray(), exact);
      std::vector<cv::Point3d> in_space;
      for (const cv::Point2d& point : points) in_space.emplace_back(point.x, point.y, 1.0);
      cv::projectPoints(in_space, cv::Vec3d(), cv::Vec3d(), K, D, back);
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      // Of what OpenCV's iteration does not undo there is nothing to compare.
      if (cv::norm(back[i] - pixels[i]) > 1e-7) continue;
      const cv::Point2d ours = ideal(camera, pixels[i]);
      EXPECT_LT(cv::norm(ours - points[i]) / (1.0 + ours.dot(ours)), 1e-9)
          << lens.name << ' ' << pixels[i];
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const Eigen::Vector2d pixel = camera.pixel({-points[i].y, -points[i].x}, 1.0);
      EXPECT_LT(cv::norm(cv::Point2d(pixel.x(), pixel.y()) - back[i]), 1e-8) << lens.name;
    }
  }
}

// By central differences of floor_point itself.
TEST(Lens, NeighbourhoodIsTheDerivative) {
  constexpr double kStep = 1e-4;
  RandomStream random(6, "lens");
  for (const Lens& lens : lenses()) {
    const Camera camera(lens.model);
    for (int i = 0; i < 40; ++i) {
      const Tilt tilt = i % 2 == 0 ? Tilt{} : Tilt{0.1, -0.05};
      const Stance stance(2.0, tilt);
      const Eigen::Vector2d pixel(random.uniform(60, 580), random.uniform(60, 420));
      const auto difference = [&](const Eigen::Vector2d& way) -> Eigen::Vector2d {
        return (camera.floor_point(pixel + kStep * way, stance) -
                camera.floor_point(pixel - kStep * way, stance)) /
               (2.0 * kStep);
      };
      const double turn = random.uniform(-3, 3);
      const Eigen::Vector2d moved = difference({std::cos(turn), std::sin(turn)});
      const Camera::Neighbourhood near = camera.neighbourhood(pixel, turn, tilt);
      EXPECT_NEAR(std::remainder(near.heading_rad - std::atan2(moved.y(), moved.x()), 2 * M_PI),
                  0.0, 1e-6);
      Eigen::Matrix2d J;
      J << difference({1, 0}), difference({0, 1});
      const double on_axis_m = 2.0 / std::sqrt(lens.model.fx * lens.model.fy);
      EXPECT_NEAR(near.stretch / (std::sqrt(std::abs(J.determinant())) / on_axis_m), 1.0, 1e-5);
    }
  }
}

// A net of floor points, each looked for in both pictures.
TEST(Lens, OverlapIsThatOfWhatBothSee) {
  const Camera camera(lenses()[1].model);
  const auto is_seen = [&](const Eigen::Vector2d& floor) {
    const Eigen::Vector2d p = camera.pixel(floor, 1.0);
    return p.x() >= -0.5 && p.x() < 639.5 && p.y() >= -0.5 && p.y() < 479.5;
  };
  for (const Pose& motion : {Pose{0.9, -1.2, 0.6}, Pose{2.5, 1.0, -2.0}, Pose{0.0, 0.0, 1.5}}) {
    int in_a = 0;
    int in_both = 0;
    for (int i = -200; i < 200; ++i) {
      for (int k = -200; k < 200; ++k) {
        const Eigen::Vector2d floor(0.03 * i, 0.03 * k);
        if (!is_seen(floor)) continue;
        ++in_a;
        in_both += is_seen(transform(inverse(motion), floor));
      }
    }
    EXPECT_NEAR(footprint_overlap(camera, 1.0, 1.0, motion), in_both / static_cast<double>(in_a),
                0.01);
  }
  EXPECT_NEAR(footprint_overlap(camera, 1.0, 1.0, {}), 1.0, 1e-9);
}

TEST(Lens, RefusesWhatHasNoOneRayAPixel) {
  const auto refusal = [](DistortionModel distortion, double focal_px,
                          const std::array<double, 8>& coefficients) {
    return test::input_error_of(
        [&] { Camera camera(lens_model(distortion, focal_px, coefficients)); });
  };
  constexpr auto kFisheye = DistortionModel::equidistant;
  constexpr auto kRational = DistortionModel::rational_polynomial;
  EXPECT_THAT(refusal(kFisheye, 250, {}), HasSubstr("90 degrees or more from its axis"));
  EXPECT_EQ(refusal(kFisheye, 262, {}), "(nothing thrown)");
  EXPECT_THAT(refusal(kFisheye, 400, {-0.5}), HasSubstr("folds the picture over at pixel (-0.5"));
  // Falls from 0.75 to 1.03 rad and rises again beyond: the corners are reached, but not first.
  EXPECT_THAT(refusal(kFisheye, 400, {-0.9, 0.33, 0.0, 0.0}), HasSubstr("folds the picture over"));
  EXPECT_THAT(refusal(kRational, 500, {0, 0, 0, 0, 0, 4.0, 0, 0}),
              HasSubstr("coefficients must be k1 k2 p1 p2 k3 k4 k5 k6"));
  EXPECT_THAT(refusal(kFisheye, 500, {0, 0, 0, 0, 0.1}), HasSubstr("has 4 coefficients"));
  EXPECT_THAT(refusal(DistortionModel::radial_tangential, 500, {0, 0, 0, 0, 0, 0.1}),
              HasSubstr("has 5 coefficients"));
}

TEST(Lens, APixelThatNothingReachesIsNaN) {
  CameraModel model = lens_model(DistortionModel::equidistant, 500, {-0.2});
  const Camera camera = unmounted(model);
  // It rises up to sqrt(1 / 0.6) = 1.29 rad, shown at 0.86 focal lengths.
  EXPECT_TRUE(camera.floor_point({322.7 + 0.85 * 500, 236.1}, 1.0).allFinite());
  EXPECT_FALSE(camera.floor_point({322.7 + 0.87 * 500, 236.1}, 1.0).allFinite());
  EXPECT_TRUE(camera.model().has_distortion());
  EXPECT_TRUE(lens_model(DistortionModel::equidistant, 500, {}).has_distortion());
  EXPECT_FALSE(lens_model(DistortionModel::rational_polynomial, 500, {}).has_distortion());
}

}  // namespace
}  // namespace fathom
