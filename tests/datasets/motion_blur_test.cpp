// The direction of the blur, against that in which pictures move.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "flat_world.hpp"

namespace fathom {
namespace {

/// Second moments of what is brighter than the floor around it; pixels squared.
Eigen::Matrix2d spread(const cv::Mat& picture) {
  const Eigen::Vector2d middle = test::dot_in(picture);
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  double weight = 0.0;
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      const double grey = std::max(0, picture.at<uchar>(v, u) - 24);
      const Eigen::Vector2d from_middle = Eigen::Vector2d(u, v) - middle;
      sum += grey * from_middle * from_middle.transpose();
      weight += grey;
    }
  }
  return sum / weight;
}

struct Blurring {
  const char* name;
  bool is_mirrored;
  double fx;
  Tilt tilt;
};

// A dot is drawn out along the way that it takes in the picture as the body moves on.
TEST(MotionBlur, IsAlongTheWayOfTheFloorInThePicture) {
  for (const Blurring& blurring :
       {Blurring{"plain", false, 400.0, {}}, Blurring{"mirrored", true, 400.0, {}},
        Blurring{"oblong pixels", false, 900.0, {}}, Blurring{"all", true, 900.0, {0.2, -0.3}}}) {
    SCOPED_TRACE(blurring.name);
    CameraModel model;
    model.fx = blurring.fx;
    model.fy = 400.0;
    model.mount_yaw_rad = 0.6;
    model.is_mirrored = blurring.is_mirrored;
    const View view{{0, 0, 0}, 2.0, blurring.tilt, 0.5};
    const Camera camera(model);
    const Eigen::Vector2d dot =
        camera.floor_point({model.cx, model.cy}, {view.altitude_m, view.tilt});
    const FloorRenderer renderer = test::renderer_of(test::dot_world(dot), model);
    View next = view;
    next.pose = {0.02 * std::cos(view.motion_rad), 0.02 * std::sin(view.motion_rad), 0.0};
    const Eigen::Vector2d way =
        (test::dot_in(renderer.render(next)) - test::dot_in(renderer.render(view))).normalized();
    PictureEffects effects;
    effects.camera.motion_blur_px = 30.0;
    const Eigen::Matrix2d widened =
        spread(renderer.render(view, effects)) - spread(renderer.render(view));
    const Eigen::Vector2d across(-way.y(), way.x());
    EXPECT_GT(way.dot(widened * way), 40.0);
    EXPECT_LT(std::abs(across.dot(widened * way)), 0.05 * way.dot(widened * way));
  }
}

}  // namespace
}  // namespace fathom
