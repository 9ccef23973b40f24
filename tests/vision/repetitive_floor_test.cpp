// Floors that repeat themselves: what agrees may be the next tile.

#include <array>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/core/random.hpp"
#include "fathom/vision/registration.hpp"
#include "vision/labelled.hpp"
#include "vision/points.hpp"
#include "vision/small_model.hpp"
#include "vision/textured_floor.hpp"

namespace fathom {
namespace {

using test::kTrueMotion;
using test::labelled;
using test::Points;
using ::testing::HasSubstr;

constexpr double kTilesAltitudeM = 1.5;
constexpr double kFloorPixelM = 0.004;
constexpr int kSidePx = 1600;

Camera tile_camera() {
  return Camera(test::small_model());
}

// Square tiles of one texture, of a side of so many pixels, and a grain that is nowhere the same.
TexturedFloor tiles(int side_px, double grain) {
  const cv::Mat tile = TexturedFloor(side_px, kFloorPixelM, 4).picture();
  const int count = kSidePx / side_px + 1;
  cv::Mat floor;
  cv::repeat(tile, count, count, floor);
  cv::Mat noise(floor.size(), CV_32F);
  cv::RNG(7).fill(noise, cv::RNG::NORMAL, 0.0, grain);
  cv::GaussianBlur(noise, noise, cv::Size(), 1.2);
  floor.convertTo(floor, CV_32F, 0.6, 50.0);
  floor += noise;
  floor.convertTo(floor, CV_8U);
  return {floor, kFloorPixelM};
}

FloorFeatures seen_from(const TexturedFloor& floor, const Pose& pose) {
  return on_floor(FeatureExtractor().extract(floor.seen(tile_camera(), pose, kTilesAltitudeM)),
                  tile_camera(), kTilesAltitudeM);
}

// From places that share nothing; a pixel is 4.3 mm there and the largest error 32 mm.
TEST(RepetitiveFloor, TilesFarLargerThanTheErrorAreNotTakenForEachOther) {
  const std::vector<Pose> poses{
      {-2.1, -2.0, 0.02}, {-2.0, 1.9, -0.03}, {0.2, 0.1, 0.05}, {1.9, -1.8, 0.0}, {2.1, 2.0, 1.57}};
  for (const int side_px : {70, 95, 130}) {
    const TexturedFloor floor = tiles(side_px, 12.0);
    std::vector<FloorFeatures> seen;
    for (const Pose& pose : poses) seen.push_back(seen_from(floor, pose));
    for (std::size_t i = 0; i < seen.size(); ++i) {
      for (std::size_t k = i + 1; k < seen.size(); ++k) {
        const Registration result = register_pair(seen[i], seen[k], {}, 1);
        EXPECT_FALSE(result.found)
            << side_px << ": " << i << " " << k << ", " << result.evidence.places << " places, "
            << result.evidence.rival_places << ", " << result.evidence.false_alarms;
      }
    }
  }
}

// A square lattice, each point of which is taken for its own image or that of a neighbour.
TEST(RepetitiveFloor, ALatticeIsRefusedWhateverItsPeriod) {
  for (const double period_m : {0.3, 0.5, 2.0}) {
    RandomStream random(6);
    Points p, q;
    for (int i = 0; i < 400; ++i) {
      q.push_back(period_m * Eigen::Vector2d(i % 20 - 10, i / 20 - 10));
      const auto column = static_cast<double>(random.index(3));
      const Eigen::Vector2d shift = period_m * Eigen::Vector2d(column, double(random.index(3)));
      p.push_back(transform(kTrueMotion, q.back() + shift));
    }
    const Registration refused = register_pair(labelled(p), labelled(q), {}, 1);
    EXPECT_FALSE(refused.found) << period_m;
    EXPECT_GE(refused.evidence.places, 40) << period_m;
    EXPECT_GE(refused.evidence.rival_places, 30) << period_m;
  }
}

// 60 places by a motion and 16 by the next period are no chance, P = 2e-16.
TEST(RepetitiveFloor, ARivalWithALargeShareOfThePlacesIsARepetition) {
  for (const int elsewhere : {10, 16}) {
    RandomStream random(8);
    Points p, q;
    for (int i = 0; i < 60 + elsewhere; ++i) {
      const double x = random.uniform(-1.3, 1.3);
      q.emplace_back(x, random.uniform(-1.0, 1.0));
      const Eigen::Vector2d shift(i < 60 ? 0.0 : 0.8, 0.0);
      p.push_back(transform(kTrueMotion, q.back() + shift) + test::noise(random, 0.001));
    }
    const Registration result = register_pair(labelled(p), labelled(q), {}, 1);
    EXPECT_LT(result.evidence.false_alarms, DecisionOptions{}.max_false_alarms);
    EXPECT_EQ(result.found, elsewhere == 10) << result.reason;
    if (elsewhere == 16) {
      EXPECT_THAT(result.reason, HasSubstr("the floor repeats"));
    }
  }
}

// However many places the best motion has, and however few of them are counted at least.
TEST(RepetitiveFloor, ARivalIsCountedAsFarAsTheBestMotion) {
  for (const auto& [most_places, scale] : {std::pair(200, 10), std::pair(3, 1)}) {
    RandomStream random(9);
    Points p, q;
    for (int i = 0; i < 180 * scale; ++i) {
      const double x = random.uniform(-1.3, 1.3);
      q.emplace_back(x, random.uniform(-1.0, 1.0));
      const Eigen::Vector2d shift(i < 120 * scale ? 0.0 : 0.8, 0.0);
      p.push_back(transform(kTrueMotion, q.back() + shift));
    }
    RegistrationOptions options;
    options.ransac.max_error_m = 0.004;
    options.tuning.decision.most_places = most_places;
    const Registration refused = register_pair(labelled(p), labelled(q), options, 1);
    EXPECT_FALSE(refused.found) << scale;
    EXPECT_GT(refused.evidence.rival_places, 50 * scale);
    EXPECT_THAT(refused.reason, HasSubstr("the floor repeats"));
  }
}

}  // namespace
}  // namespace fathom
