#include "fathom/report/footprints.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <random>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/level_camera.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::camera;

// A lawnmower: legs of `count` keyframes, to and fro.
std::vector<KeyframePicture> lawnmower(int legs, int count, double step_m, double apart_m) {
  std::vector<KeyframePicture> keyframes;
  for (int leg = 0; leg < legs; ++leg) {
    for (int i = 0; i < count; ++i) {
      const double along = step_m * (leg % 2 == 0 ? i : count - 1 - i);
      keyframes.push_back({static_cast<std::int64_t>(keyframes.size()), 2.0,
                           Pose{along, apart_m * leg, leg % 2 == 0 ? 0.0 : 3.14159265}});
    }
  }
  return keyframes;
}

double overlap(const std::vector<KeyframePicture>& all, std::size_t i, std::size_t k) {
  return footprint_overlap(camera(), all[i].stance, all[k].stance,
                           compose(inverse(all[i].pose), all[k].pose));
}

// By the definition, over all pairs.
double naive_other_pass(const std::vector<KeyframePicture>& all, std::size_t i) {
  double largest = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    bool is_other = false;
    for (std::size_t m = std::min(i, k); m <= std::max(i, k); ++m) {
      if (overlap(all, i, m) == 0.0) is_other = true;
    }
    if (is_other) largest = std::max(largest, overlap(all, i, k));
  }
  return largest;
}

TEST(Footprints, OfAStraightLegByHand) {
  const auto all = footprints(camera(), lawnmower(1, 5, 0.3, 0.0));
  ASSERT_EQ(all.size(), 5u);
  EXPECT_FALSE(all[0].overlap_previous);
  // 0.3 m of 1.2 m are new each time; a single pass.
  for (std::size_t i = 1; i < 5; ++i) EXPECT_NEAR(*all[i].overlap_previous, 0.75, 1e-6);
  for (const Footprint& one : all) {
    EXPECT_EQ(one.overlap_other_pass, 0.0);
    EXPECT_FALSE(one.other_pass);
  }
  // Top left of a picture is ahead and to port.
  EXPECT_NEAR((all[2].corners[0] - Eigen::Vector2d(0.6 + 0.6, 0.8)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((all[2].corners[2] - Eigen::Vector2d(0.6 - 0.6, -0.8)).norm(), 0.0, 1e-12);
}

TEST(Footprints, OfLegsTheNextLegIsTheOtherPass) {
  // 0.4 m apart, 1.6 m wide: the next leg sees three quarters.
  const auto all = footprints(camera(), lawnmower(2, 20, 0.3, 0.4));
  EXPECT_NEAR(all[3].overlap_other_pass, 0.75, 1e-6);
  EXPECT_EQ(all[3].other_pass, 36u);
  EXPECT_NEAR(all[36].overlap_other_pass, 0.75, 1e-6);
}

TEST(Footprints, AgreeWithAllPairs) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> noise(-0.2, 0.2);
  auto keyframes = lawnmower(6, 25, 0.5, 0.7);
  for (KeyframePicture& one : keyframes) {
    one.pose = compose(one.pose, Pose{noise(random), noise(random), 5 * noise(random)});
    one.stance.altitude_m += 4.0 * noise(random);
  }
  const auto all = footprints(camera(), keyframes);
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0) {
      EXPECT_EQ(*all[i].overlap_previous, overlap(keyframes, i - 1, i)) << i;
    }
    EXPECT_NEAR(all[i].overlap_other_pass, naive_other_pass(keyframes, i), 1e-12) << i;
    if (all[i].other_pass) {
      EXPECT_NEAR(overlap(keyframes, i, *all[i].other_pass), all[i].overlap_other_pass, 1e-12);
    }
  }
}

TEST(Footprints, AHundredThousandKeyframesTakeSeconds) {
  const auto keyframes = lawnmower(100, 1000, 0.4, 0.8);
  const auto begin = std::chrono::steady_clock::now();
  const auto all = footprints(camera(), keyframes);
  const std::chrono::duration<double> took = std::chrono::steady_clock::now() - begin;
  EXPECT_LT(took.count(), 60.0);  // all pairs would take an hour
  EXPECT_NEAR(all[50'500].overlap_other_pass, 0.5, 1e-6);
}

TEST(Footprints, TheFileHasALineEach) {
  const auto all = footprints(camera(), lawnmower(2, 20, 0.3, 0.4));
  std::istringstream lines(footprints_csv(all));
  std::string line;
  std::getline(lines, line);
  const auto columns = 1 + std::count(line.begin(), line.end(), ',');
  EXPECT_EQ(columns, 13);
  std::size_t count = 0;
  while (std::getline(lines, line)) {
    EXPECT_EQ(1 + std::count(line.begin(), line.end(), ','), columns);
    EXPECT_TRUE(line.starts_with(std::to_string(count) + "," + std::to_string(count) + ","));
    ++count;
  }
  EXPECT_EQ(count, all.size());
}

TEST(Footprints, OfNothingAndOfNonsense) {
  EXPECT_TRUE(footprints(camera(), {}).empty());
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<KeyframePicture> wild{{0, 2.0, {}}, {1, 2.0, {kNaN, 0, 0}}};
  EXPECT_THAT(test::input_error_of([&] { footprints(camera(), wild); }),
              testing::HasSubstr("keyframe 1 is not finite"));
  const std::vector<KeyframePicture> sunk{{0, 0.0, {}}};
  EXPECT_THAT(test::input_error_of([&] { footprints(camera(), sunk); }),
              testing::HasSubstr("altitude"));
  // Two keyframes in one place are a single pass, at altitudes that differ the smaller counts.
  const std::vector<KeyframePicture> above{{0, 2.0, {}}, {1, 4.0, {}}};
  EXPECT_NEAR(*footprints(camera(), above)[1].overlap_previous, 1.0, 1e-6);
}

}  // namespace
}  // namespace fathom
