// A camera whose pictures are mirrored sees in column W − 1 − u what another one sees in u.

#include <gtest/gtest.h>

#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

// The same camera, its picture exchanged left for right: of Brown's terms that of p2 is odd in u.
Camera exchanged(CameraModel model) {
  model.is_mirrored = !model.is_mirrored;
  model.cx = model.width - 1 - model.cx;
  model.distortion[3] = -model.distortion[3];
  return Camera(model);
}

CameraModel tilted_lens() {
  CameraModel model;
  model.cx = 300.0;
  model.distortion = {-0.2, 0.05, 1e-3, -2e-3, 0.0};
  model.mount_x_m = 0.3;
  model.mount_y_m = -0.2;
  model.mount_yaw_rad = 0.7;
  return model;
}

TEST(MirroredCamera, SeesWhatTheOtherSeesInTheExchangedColumn) {
  const Camera camera{tilted_lens()};
  const Camera mirrored = exchanged(tilted_lens());
  const Stance stance{1.7, MeasuredTilt{{0.05, -0.1}, 0.0}};
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0, 0), Eigen::Vector2d(600, 30),
                                       Eigen::Vector2d(320, 240), Eigen::Vector2d(10.5, 470)}) {
    const Eigen::Vector2d exchanged_pixel(camera.model().width - 1 - pixel.x(), pixel.y());
    const Eigen::Vector2d point = camera.floor_point(pixel, stance);
    EXPECT_LT((mirrored.floor_point(exchanged_pixel, stance) - point).norm(), 1e-12);
    EXPECT_LT((mirrored.pixel(point, stance) - exchanged_pixel).norm(), 1e-6);
    // A direction in the one is the direction with u turned round in the other.
    const double turn_rad = 0.4;
    EXPECT_NEAR(wrap_angle(mirrored.heading(M_PI - turn_rad) - camera.heading(turn_rad)), 0.0,
                1e-12);
    const auto of = camera.neighbourhood(pixel, turn_rad, stance.tilt);
    const auto other = mirrored.neighbourhood(exchanged_pixel, M_PI - turn_rad, stance.tilt);
    EXPECT_NEAR(wrap_angle(of.heading_rad - other.heading_rad), 0.0, 1e-12);
    EXPECT_NEAR(of.stretch, other.stretch, 1e-12);
  }
  const auto corners = camera.footprint(stance);
  const auto same = mirrored.footprint(stance);
  for (std::size_t i = 0; i < corners.size(); ++i) EXPECT_LT((corners[i] - same[i]).norm(), 1e-12);
  EXPECT_NEAR(footprint_overlap(camera, stance, stance, {0.4, 0.3, 0.2}),
              footprint_overlap(mirrored, stance, stance, {0.4, 0.3, 0.2}), 1e-12);
}

TEST(MirroredCamera, IsAnotherKey) {
  CameraModel model;
  Hash plain;
  model.add_to(plain);
  model.is_mirrored = true;
  Hash mirrored;
  model.add_to(mirrored);
  EXPECT_NE(plain.value(), mirrored.value());
}

}  // namespace
}  // namespace fathom
