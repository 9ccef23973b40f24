#include <cmath>
#include <limits>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/core/random.hpp"
#include "fathom/report/match_picture.hpp"
#include "pixels.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::HasSubstr;

// A floor of blurred noise, 5 cm a pixel, and what a camera sees of it from a pose.
class Floor {
 public:
  Floor() : texture_(800, 800, CV_8U) {
    RandomStream random(1, "floor");
    for (int v = 0; v < 800; ++v) {
      for (int u = 0; u < 800; ++u) {
        texture_.at<unsigned char>(v, u) = static_cast<unsigned char>(random.index(256));
      }
    }
    cv::GaussianBlur(texture_, texture_, {}, 6.0);
    cv::normalize(texture_, texture_, 20, 240, cv::NORM_MINMAX);
  }

  FloorPicture seen(const Camera& camera, double altitude_m, const Pose& pose) const {
    cv::Mat image(camera.model().height, camera.model().width, CV_8U);
    for (int v = 0; v < image.rows; ++v) {
      for (int u = 0; u < image.cols; ++u) {
        const Eigen::Vector2d point =
            transform(pose, camera.floor_point(Eigen::Vector2d(u, v), altitude_m));
        image.at<unsigned char>(v, u) =
            texture_.at<unsigned char>(static_cast<int>(std::lround(400 - 20 * point.x())),
                                       static_cast<int>(std::lround(400 - 20 * point.y())));
      }
    }
    return {image, camera, altitude_m};
  }

 private:
  cv::Mat texture_;
};

Camera camera_with(double k1, double yaw_rad) {
  CameraModel model;
  model.width = 160;
  model.height = 120;
  model.fx = model.fy = 150;
  model.cx = 79.5;
  model.cy = 59.5;
  model.distortion[0] = k1;
  model.mount_x_m = 0.3;
  model.mount_yaw_rad = yaw_rad;
  return Camera(model);
}

// Mean difference of blue and red in the middle of the overlay: none where A and B agree.
double disagreement(const cv::Mat& overlay) {
  const cv::Rect middle(overlay.cols * 2 / 5, overlay.rows * 2 / 5, overlay.cols / 5,
                        overlay.rows / 5);
  cv::Mat channels[3];
  cv::split(overlay(middle), channels);
  cv::Mat difference;
  cv::absdiff(channels[0], channels[2], difference);
  return cv::mean(difference)[0];
}

TEST(Overlay, IsGreyAtTheRightMotionAndColouredAtAWrongOne) {
  const Floor floor;
  for (const double k1 : {0.0, -0.15}) {
    const Camera camera = camera_with(k1, 0.4);
    const Pose pose_a{0.5, -0.3, 0.2};
    const Pose motion{0.9, 0.7, -0.5};
    const FloorPicture a = floor.seen(camera, 5.0, pose_a);
    const FloorPicture b = floor.seen(camera, 6.5, compose(pose_a, motion));  // another altitude
    const double right = disagreement(render_overlay(a, b, motion));
    EXPECT_LT(right, 12.0) << k1;
    for (const Pose& wrong : {Pose{1.9, 0.7, -0.5}, Pose{0.9, 0.7, -0.1}, inverse(motion)}) {
      EXPECT_GT(disagreement(render_overlay(a, b, wrong)), 2.0 * right + 5.0) << k1;
    }
  }
}

TEST(Overlay, BAheadOfAIsDrawnAboveIt) {
  const Camera camera = camera_with(0.0, 0.0);
  const cv::Mat grey(120, 160, CV_8UC3, cv::Scalar(128, 128, 128));
  const cv::Mat drawn = render_overlay({grey, camera, 5.0}, {grey, camera, 5.0}, {2, 1, 0});
  const Eigen::Vector2d a = test::mean_position(drawn, palette::orange);
  const Eigen::Vector2d b = test::mean_position(drawn, palette::blue);
  EXPECT_LT(b.y(), a.y());  // 2 m ahead
  EXPECT_LT(b.x(), a.x());  // 1 m to port
}

TEST(Overlay, Refuses) {
  const Camera camera = camera_with(0.0, 0.0);
  const FloorPicture good{cv::Mat(120, 160, CV_8U, cv::Scalar(9)), camera, 5.0};
  const auto error = [&](const FloorPicture& b, const Pose& motion) {
    return input_error_of([&] { render_overlay(good, b, motion); });
  };
  EXPECT_EQ(error(good, {}), "(nothing thrown)");
  EXPECT_THAT(error({cv::Mat(), camera, 5.0}, {}), HasSubstr("empty"));
  EXPECT_THAT(error({cv::Mat(10, 20, CV_8U), camera, 5.0}, {}),
              HasSubstr("picture B has 20 x 10 pixels, its camera 160 x 120"));
  EXPECT_THAT(error({good.image, camera, 0.0}, {}), HasSubstr("altitude"));
  EXPECT_THAT(error(good, {std::numeric_limits<double>::quiet_NaN(), 0, 0}), HasSubstr("finite"));
  EXPECT_THAT(error(good, {1e6, 0, 0}), HasSubstr("too far apart"));
}

}  // namespace
}  // namespace fathom
