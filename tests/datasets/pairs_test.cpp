// The generator of pairs with truth: overlap, altitudes and headings as it says.

#include "support/pairs/pairs.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/input_error.hpp"

namespace fathom {
namespace {

const Eigen::AlignedBox2d kWorldBox(Eigen::Vector2d(-6, -6), Eigen::Vector2d(6, 6));

// Overlap by counting points of a grid over the smaller footprint.
double counted_overlap(const Camera& camera, const test::ViewPair& pair) {
  const bool a_is_smaller = pair.a.altitude_m < pair.b.altitude_m;
  const View& small = a_is_smaller ? pair.a : pair.b;
  const View& large = a_is_smaller ? pair.b : pair.a;
  int inside = 0;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 100; ++k) {
      const Eigen::Vector2d pixel((i + 0.5) * 6.4 - 0.5, (k + 0.5) * 4.8 - 0.5);
      const Eigen::Vector2d world =
          transform(small.pose, camera.floor_point(pixel, small.altitude_m));
      const Eigen::Vector2d seen =
          camera.pixel(transform(inverse(large.pose), world), large.altitude_m);
      if (seen.x() > -0.5 && seen.x() < 639.5 && seen.y() > -0.5 && seen.y() < 479.5) ++inside;
    }
  }
  return inside / 1e4;
}

TEST(Pairs, OverlapAsTheirBucketsSay) {
  const Camera camera;
  RandomStream stream(5);
  double least_ratio = 2.0, greatest_ratio = 0.5;
  for (int i = 0; i < 30; ++i) {
    const auto buckets = test::tenths();
    const auto pairs = test::draw_pairs(camera, kWorldBox, buckets, stream);
    ASSERT_EQ(pairs.size(), 10U);
    for (std::size_t k = 0; k < 10; ++k) {
      EXPECT_GE(pairs[k].overlap, buckets[k].low - 1e-5);
      EXPECT_LT(pairs[k].overlap, buckets[k].high + 1e-5);
      EXPECT_NEAR(counted_overlap(camera, pairs[k]), pairs[k].overlap, 0.02);
      EXPECT_EQ(pairs[k].a.pose, pairs[0].a.pose);
    }
    const double ratio = pairs[0].a.altitude_m / pairs[0].b.altitude_m;
    least_ratio = std::min(least_ratio, ratio);
    greatest_ratio = std::max(greatest_ratio, ratio);
    EXPECT_NEAR(pairs[0].a.altitude_m * pairs[0].b.altitude_m, 4.0, 1e-12);
  }
  EXPECT_GE(least_ratio, 0.5);
  EXPECT_LT(least_ratio, 0.6);
  EXPECT_LE(greatest_ratio, 2.0);
  EXPECT_GT(greatest_ratio, 1.7);
}

TEST(Pairs, OfAWorldTooSmallAreRefused) {
  RandomStream stream(5);
  const Eigen::AlignedBox2d small(Eigen::Vector2d(-1, -1), Eigen::Vector2d(1, 1));
  EXPECT_NE(test::input_error_of([&] {
              test::draw_view(Camera(), small, {}, stream);
            }).find("is too small"),
            std::string::npos);
}

TEST(Conditions, DrawTheirTiltAndASeed) {
  RandomStream stream(2);
  View a, b;
  test::draw_condition(a, test::condition_named("tilt_2deg"), stream);
  test::draw_condition(b, test::condition_named("noise"), stream);
  EXPECT_GT(std::abs(a.tilt.roll_rad) + std::abs(a.tilt.pitch_rad), 1e-4);
  EXPECT_LT(std::abs(a.tilt.roll_rad) + std::abs(a.tilt.pitch_rad), 0.25);
  EXPECT_TRUE(b.tilt.is_level());
  EXPECT_NE(a.seed, b.seed);
  EXPECT_NE(test::input_error_of([] { test::condition_named("hazy"); }).find("no condition"),
            std::string::npos);
}

}  // namespace
}  // namespace fathom
