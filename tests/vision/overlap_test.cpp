#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

// 2 m wide to port and starboard, 1 m fore and aft at an altitude of 1 m.
Camera camera() {
  CameraModel model;
  model.width = 200;
  model.height = 100;
  model.fx = model.fy = 100.0;
  model.cx = 99.5;
  model.cy = 49.5;
  return Camera(model);
}

TEST(FootprintOverlap, IsTheSharedPartOfTheSmallerFootprint) {
  EXPECT_NEAR(footprint_overlap(camera(), 1.0, 1.0, {}), 1.0, 1e-6);
  EXPECT_NEAR(footprint_overlap(camera(), 1.0, 1.0, {0.25, 0.0, 0.0}), 0.75, 1e-6);
  EXPECT_NEAR(footprint_overlap(camera(), 1.0, 1.0, {0.0, 0.5, 0.0}), 0.75, 1e-6);
  EXPECT_NEAR(footprint_overlap(camera(), 1.0, 1.0, {0.5, 1.0, M_PI}), 0.25, 1e-6);
  EXPECT_EQ(footprint_overlap(camera(), 1.0, 1.0, {1.01, 0.0, 0.0}), 0.0);
  // Crosswise a square of 1 m a side is shared.
  EXPECT_NEAR(footprint_overlap(camera(), 1.0, 1.0, {0.0, 0.0, M_PI / 2}), 0.5, 1e-6);
  // Twice as high the picture holds the other one.
  EXPECT_NEAR(footprint_overlap(camera(), 2.0, 1.0, {0.4, 0.4, 0.0}), 1.0, 1e-6);
  EXPECT_NEAR(footprint_overlap(camera(), 1.0, 2.0, {-0.4, -0.4, 0.0}), 1.0, 1e-6);
}

TEST(FootprintOverlap, OfASwappedPairIsTheSame) {
  const Pose motion{0.3, -0.4, 2.0};
  EXPECT_NEAR(footprint_overlap(camera(), 1.0, 1.3, motion),
              footprint_overlap(camera(), 1.3, 1.0, inverse(motion)), 1e-6);
}

// Sides that lie on one another, but for rounding: parallel legs, there and back.
TEST(FootprintOverlap, OfParallelLegsIsThatOfRectangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-1.0, 1.0);
  for (int i = 0; i < 20'000; ++i) {
    const double turn = std::pow(10.0, -9.0 + 3.0 * std::abs(share(random))) * share(random);
    const Pose motion{i % 3 == 0 ? 0.0 : 0.99 * share(random),
                      i % 5 == 0 ? 0.0 : 1.99 * share(random), (i % 2 == 0 ? M_PI : 0.0) + turn};
    EXPECT_NEAR(footprint_overlap(camera(), 1.0, 1.0, motion),
                (1.0 - std::abs(motion.x)) * (1.0 - 0.5 * std::abs(motion.y)), 1e-5)
        << motion.x << ", " << motion.y << ", " << motion.theta;
  }
  EXPECT_EQ(footprint_overlap(camera(), 1.0, 1.0, {1e300, 0.0, 0.0}), 0.0);
}

}  // namespace
}  // namespace fathom
