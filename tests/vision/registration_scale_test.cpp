// Lengths in pixels: of the coarser picture, whatever the altitude.

#include <utility>

#include <gtest/gtest.h>

#include "fathom/core/input_error.hpp"
#include "fathom/vision/registration.hpp"
#include "vision/sea_floor.hpp"

namespace fathom {
namespace {

using test::seen_at;

// The same picture from twice as far has pixels twice as wide, and all it sees is twice as large.
TEST(RegisterPair, ErrorsInPixelsScaleWithTheAltitude) {
  const Pose B{0.15, 0.05, 0.2};
  const FloorFeatures a = seen_at({}, 1.5);
  const FloorFeatures b = seen_at(B, 1.5);
  const auto scaled = [](FloorFeatures features, double scale) {
    for (Eigen::Vector2d& point : features.points) point *= scale;
    for (double& size_m : features.sizes_m) size_m *= scale;
    features.viewpoint.camera_m *= scale;
    features.viewpoint.altitude_m *= scale;
    features.viewpoint.metres_per_pixel *= scale;
    return features;
  };
  const Registration plain = register_pair(a, b, {}, 1);
  ASSERT_TRUE(plain.found);
  for (const double scale : {0.25, 4.0, 16.0}) {
    const Registration again = register_pair(scaled(a, scale), scaled(b, scale), {}, 1);
    ASSERT_TRUE(again.found);
    EXPECT_EQ(again.inliers, plain.inliers);
    EXPECT_NEAR(again.motion.x, scale * plain.motion.x, 1e-12 * scale);
    EXPECT_NEAR(again.motion.theta, plain.motion.theta, 1e-12);
    const Eigen::Vector3d unit(scale, scale, 1.0);
    const Eigen::Matrix3d expected = unit.asDiagonal() * plain.covariance * unit.asDiagonal();
    EXPECT_LT((again.covariance - expected).norm(), 1e-9 * expected.norm());
  }
}

// The picture from further up has the coarser pixels, whichever of the two it is.
TEST(RegisterPair, ErrorsInPixelsAreThoseOfTheCoarserPicture) {
  const FloorFeatures a = seen_at({}, 1.2);
  const FloorFeatures b = seen_at({0.15, 0.05, 0.2}, 1.6);
  RegistrationOptions in_metres;
  in_metres.ransac.max_error_m = 7.5 * b.viewpoint.metres_per_pixel;
  for (const auto& [from, to] : {std::pair{a, b}, std::pair{b, a}}) {
    const Registration by_pixels = register_pair(from, to, {}, 1);
    ASSERT_TRUE(by_pixels.found);
    EXPECT_EQ(by_pixels.inliers, register_pair(from, to, in_metres, 1).inliers);
  }
}

TEST(RegisterPair, WithoutPixelsAnErrorInMetresIsNeeded) {
  EXPECT_THROW(register_pair({}, {}, {}, 1), InputError);
}

}  // namespace
}  // namespace fathom
