#include "fathom/vision/camera.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"

namespace fathom {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// A wide-angle action camera behind a flat port: barrel distortion that moves corners by 120
// pixels.
CameraModel wide_angle() {
  CameraModel model;
  model.fx = 410.0;
  model.fy = 405.0;
  model.cx = 322.7;
  model.cy = 236.1;
  model.distortion = {-0.28, 0.09, 0.0011, -0.0007, -0.012};
  model.mount_x_m = 0.35;
  model.mount_y_m = -0.08;
  model.mount_yaw_rad = 0.7;
  return model;
}

cv::Mat matrix_of(const CameraModel& m) {
  return (cv::Mat_<double>(3, 3) << m.fx, 0, m.cx, 0, m.fy, m.cy, 0, 0, 1);
}

cv::Mat coefficients_of(const CameraModel& m) {
  return cv::Mat(std::vector<double>(m.distortion.begin(), m.distortion.end()), true);
}

// The same camera as OpenCV sees it, in three dimensions: the axes of the camera (right, down,
// away) are, at mounting yaw 0, starboard, aft and down, that is (0, −1, 0), (−1, 0, 0), (0, 0, −1)
// of the body; with a yaw they are turned about the vertical. It stands at (mount, altitude).
cv::Point2d projected(const CameraModel& m, const Eigen::Vector2d& point, double altitude_m) {
  const double c = std::cos(m.mount_yaw_rad);
  const double s = std::sin(m.mount_yaw_rad);
  const cv::Matx33d body_from_camera(s, -c, 0, -c, -s, 0, 0, 0, -1);
  const cv::Vec3d place(m.mount_x_m, m.mount_y_m, altitude_m);
  cv::Vec3d turn;
  cv::Rodrigues(body_from_camera.t(), turn);
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{point.x(), point.y(), 0.0}}, turn,
                    -(body_from_camera.t() * place), matrix_of(m), coefficients_of(m), pixels);
  return pixels.front();
}

TEST(Camera, TopOfThePictureIsForwardAndRightIsStarboard) {
  const Camera camera;  // f = 500
  const Eigen::Vector2d ahead = camera.floor_point({319.5, 239.5 - 250.0}, 2.0);
  EXPECT_NEAR(ahead.x(), 1.0, 1e-12);
  EXPECT_NEAR(ahead.y(), 0.0, 1e-12);
  const Eigen::Vector2d right = camera.floor_point({319.5 + 250.0, 239.5}, 2.0);
  EXPECT_NEAR(right.x(), 0.0, 1e-12);
  EXPECT_NEAR(right.y(), -1.0, 1e-12);
}

TEST(Camera, TurnedToPortItSeesPortAhead) {
  CameraModel model;
  model.mount_yaw_rad = kPi / 2.0;
  model.mount_x_m = 0.4;
  const Camera camera(model);
  // Top of the picture: port of the mount. Right of the picture: ahead.
  EXPECT_NEAR((camera.floor_point({319.5, 239.5 - 250.0}, 2.0) - Eigen::Vector2d(0.4, 1.0)).norm(),
              0.0, 1e-12);
  EXPECT_NEAR((camera.floor_point({319.5 + 250.0, 239.5}, 2.0) - Eigen::Vector2d(1.4, 0.0)).norm(),
              0.0, 1e-12);
}

TEST(Camera, ADrawnArrowPointsWhereItWasLaid) {
  // On the floor from tail to tip, drawn into a picture by a camera model that is not ours.
  const CameraModel model = wide_angle();
  const double altitude_m = 2.2;
  const Eigen::Vector2d tail(0.1, -0.3);
  const Eigen::Vector2d tip(0.8, 0.25);
  cv::Mat picture = cv::Mat::zeros(model.height, model.width, CV_8U);
  cv::circle(picture, projected(model, tail, altitude_m), 3, 100, cv::FILLED);
  cv::circle(picture, projected(model, tip, altitude_m), 3, 200, cv::FILLED);
  const auto centre = [&](int value) {
    const cv::Moments m = cv::moments(picture == value, true);
    return Eigen::Vector2d(m.m10 / m.m00, m.m01 / m.m00);
  };
  const Camera camera(model);
  const double pixel_m = altitude_m / 300.0;  // distortion stretches a pixel at the border
  EXPECT_LT((camera.floor_point(centre(100), altitude_m) - tail).norm(), pixel_m);
  EXPECT_LT((camera.floor_point(centre(200), altitude_m) - tip).norm(), pixel_m);
}

TEST(Camera, PixelEqualsAThreeDimensionalProjection) {
  RandomStream random(1);
  for (int i = 0; i < 200; ++i) {
    CameraModel model = wide_angle();
    model.mount_yaw_rad = random.uniform(-kPi, kPi);
    const double altitude_m = random.uniform(0.5, 20.0);
    const Eigen::Vector2d mount(model.mount_x_m, model.mount_y_m);
    const Eigen::Vector2d point =
        mount + altitude_m * Eigen::Vector2d(random.uniform(-0.6, 0.6), random.uniform(-0.6, 0.6));
    const cv::Point2d expected = projected(model, point, altitude_m);
    const Eigen::Vector2d pixel = Camera(model).pixel(point, altitude_m);
    EXPECT_NEAR(pixel.x(), expected.x, 1e-8);
    EXPECT_NEAR(pixel.y(), expected.y, 1e-8);
  }
}

TEST(Camera, PixelUndoesFloorPoint) {
  const Camera camera(wide_angle());
  for (double u = -0.5; u <= 639.5; u += 20.0) {
    for (double v = -0.5; v <= 479.5; v += 20.0) {
      const Eigen::Vector2d pixel(u, v);
      EXPECT_LT((camera.pixel(camera.floor_point(pixel, 1.7), 1.7) - pixel).norm(), 1e-9)
          << u << " " << v;
    }
  }
}

TEST(Camera, UndistortionAgreesWithOpenCv) {
  CameraModel model = wide_angle();
  model.mount_x_m = model.mount_y_m = model.mount_yaw_rad = 0.0;
  const Camera camera(model);
  std::vector<cv::Point2d> distorted;
  for (double u = 0.0; u < 640.0; u += 71.0) {
    for (double v = 0.0; v < 480.0; v += 53.0) distorted.emplace_back(u, v);
  }
  std::vector<cv::Point2d> ideal;
  cv::undistortPoints(distorted, ideal, matrix_of(model), coefficients_of(model), cv::noArray(),
                      cv::noArray(), cv::TermCriteria(cv::TermCriteria::MAX_ITER, 500, 0.0));
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    const Eigen::Vector2d point = camera.floor_point({distorted[i].x, distorted[i].y}, 1.0);
    EXPECT_NEAR(-point.y(), ideal[i].x, 1e-10);
    EXPECT_NEAR(-point.x(), ideal[i].y, 1e-10);
  }
}

TEST(Camera, ManyPixelsAreAsOneByOne) {
  const Camera camera(wide_angle());
  const std::vector<Eigen::Vector2d> pixels{{0.0, 0.0}, {320.0, 240.0}, {639.0, 10.5}};
  const std::vector<Eigen::Vector2d> points = camera.floor_points(pixels, 3.0);
  ASSERT_EQ(points.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(points[i], camera.floor_point(pixels[i], 3.0));
  EXPECT_TRUE(camera.floor_points({}, 3.0).empty());
}

TEST(Camera, FootprintIsNotMirrored) {
  CameraModel model;
  model.mount_yaw_rad = 0.4;
  model.fy = 450.0;
  const auto corners = Camera(model).footprint(2.0);
  double doubled_area = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector2d& a = corners[i];
    const Eigen::Vector2d& b = corners[(i + 1) % 4];
    doubled_area += a.x() * b.y() - a.y() * b.x();
  }
  // Clockwise in the picture is clockwise seen from above, and x to y is counter-clockwise.
  EXPECT_NEAR(0.5 * doubled_area, -(640.0 / 500.0 * 2.0) * (480.0 / 450.0 * 2.0), 1e-12);
}

TEST(Camera, APixelThatNothingReachesIsNaN) {
  CameraModel model;
  model.fx = model.fy = 900.0;
  model.distortion = {-0.3, 0.0, 0.0, 0.0, 0.0};  // reaches out to 0.70 focal lengths
  const Camera camera(model);
  EXPECT_FALSE(camera.floor_point({319.5 + 0.72 * 900.0, 239.5}, 1.0).allFinite());
  EXPECT_TRUE(camera.floor_point({319.5 + 0.69 * 900.0, 239.5}, 1.0).allFinite());
  EXPECT_FALSE(camera.floor_point({kNaN, 239.5}, 1.0).allFinite());
  EXPECT_FALSE(camera.floor_point({1e300, -1e300}, 1.0).allFinite());
}

TEST(Camera, RefusesWhatIsNoCamera) {
  const auto with = [](auto change) {
    CameraModel model;
    change(model);
    return model;
  };
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.width = 0; })), InputError);
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.height = -1; })), InputError);
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.fx = 0.0; })), InputError);
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.fy = kNaN; })), InputError);
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.cx = kNaN; })), InputError);
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.mount_yaw_rad = kNaN; })), InputError);
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.distortion[2] = kNaN; })), InputError);
  // Folds over inside the picture: two floor points at one pixel, none at its corners.
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.distortion[0] = -0.9; })), InputError);
  EXPECT_THROW(Camera(with([](CameraModel& m) { m.distortion[4] = -2.0; })), InputError);
}

TEST(Camera, RefusesAnAltitudeThatIsNone) {
  const Camera camera;
  for (const double altitude_m : {0.0, -2.0, kNaN, std::numeric_limits<double>::infinity()}) {
    EXPECT_THROW(camera.floor_point({0.0, 0.0}, altitude_m), InputError);
    EXPECT_THROW(camera.floor_points({}, altitude_m), InputError);
    EXPECT_THROW(camera.pixel({0.0, 0.0}, altitude_m), InputError);
    EXPECT_THROW(camera.footprint(altitude_m), InputError);
  }
}

}  // namespace
}  // namespace fathom
