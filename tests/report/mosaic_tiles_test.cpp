#include <map>
#include <mutex>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/report/mosaic.hpp"
#include "known_floor.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::full_model;
using test::KnownFloor;
using test::legs;

// A floor that counts how often each picture is decoded.
class CountedFloor : public KnownFloor {
 public:
  using KnownFloor::KnownFloor;
  cv::Mat image(std::size_t i) const override {
    const std::scoped_lock lock(counting_);
    ++decoded[i];
    return KnownFloor::image(i);
  }
  mutable std::map<std::size_t, int> decoded;

 private:
  mutable std::mutex counting_;
};

struct Joined {
  cv::Mat picture;
  std::size_t tiles = 0;
  std::size_t told = 0;
};

Joined joined(const FrameSource& source, const MosaicPlan& plan, const TileOptions& options) {
  Joined all{cv::Mat(plan.size, CV_8U, cv::Scalar(kUnseen)), 0, 0};
  make_tiles(
      source, plan, options,
      [&](const MosaicTile& tile) {
        ++all.tiles;
        EXPECT_EQ(tile.window.tl(),
                  cv::Point(tile.column * options.side_px, tile.row * options.side_px));
        tile.picture.copyTo(all.picture(tile.window));
      },
      [&](std::size_t done, std::size_t of) {
        EXPECT_EQ(done, ++all.told);
        EXPECT_LE(done, of);
      });
  return all;
}

TEST(MosaicTiles, PutTogetherAreTheWholeBitForBit) {
  const KnownFloor floor(Camera(full_model()), legs(5));
  std::vector<PlacedPicture> wrong = floor.truth();
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.1);
  for (PlacedPicture& picture : wrong) {
    picture.pose = compose(picture.pose, Pose{noise(random), noise(random), noise(random)});
  }
  for (const double metres_per_pixel : {0.0123, 0.05}) {
    const MosaicBlend blend = metres_per_pixel == 0.05 ? MosaicBlend::seams : MosaicBlend::feather;
    const MosaicPlan plan =
        plan_mosaic(floor.camera(), wrong, {.metres_per_pixel = metres_per_pixel, .blend = blend});
    const cv::Mat whole = make_mosaics(floor, {&plan, 1}).front();
    for (const int side_px : {1, 37, 64, 5000}) {
      if (side_px == 1 && metres_per_pixel < 0.05) continue;  // half a minute
      const Joined tiles = joined(floor, plan, {.side_px = side_px});
      EXPECT_EQ(cv::norm(tiles.picture, whole, cv::NORM_INF), 0.0)
          << side_px << ", " << metres_per_pixel;
      EXPECT_EQ(tiles.told, tiles.tiles);
      if (side_px == 5000) {
        EXPECT_EQ(tiles.tiles, 1u);
      }
    }
  }
}

TEST(MosaicTiles, TheCacheChangesNothingButTheWork) {
  const CountedFloor floor(Camera(full_model()), legs(5));
  const MosaicPlan plan = plan_mosaic(floor.camera(), floor.truth(), {});
  const auto work = [&](std::size_t cache_bytes) {
    floor.decoded.clear();
    const Joined tiles = joined(floor, plan, {.side_px = 64, .cache_bytes = cache_bytes});
    int decoded = 0;
    for (const auto& [frame, count] : floor.decoded) decoded += count;
    return std::pair(tiles.picture, decoded);
  };
  const auto [without, often] = work(0);
  const auto [with, once] = work(100'000'000);
  EXPECT_EQ(cv::norm(without, with, cv::NORM_INF), 0.0);
  EXPECT_GT(often, 3 * once);
  // Once to lay it; the illumination is learnt from 40 of them before.
  EXPECT_LE(once, static_cast<int>(plan.pictures.size() + 40));
}

TEST(MosaicTiles, WhatIsFarFromAllPicturesIsNeverMade) {
  std::vector<PlacedPicture> far{{0, 2.0, {0, 0, 0}}, {1, 2.0, {20'000, 15'000, 0}}};
  const KnownFloor floor(Camera(full_model()), far);
  const MosaicPlan plan = plan_mosaic(floor.camera(), far, MosaicOptions::of_tiles());
  // 1.1 million by 0.9 million pixels are beyond what one file may be; they are made coarser.
  EXPECT_GT(static_cast<double>(plan.size.width) * plan.size.height, 0.9e11);
  EXPECT_LE(static_cast<double>(plan.size.width) * plan.size.height, 1e11);
  std::size_t tiles = 0;
  make_tiles(floor, plan, {.side_px = 256}, [&](const MosaicTile&) { ++tiles; });
  EXPECT_LE(tiles, 8u);
  EXPECT_GE(tiles, 2u);
}

TEST(MosaicTiles, APictureTakesLittleMemoryWhateverTheResolution) {
  // The second, from high above, covers ten thousand times as many pixels as the first.
  const Camera camera(full_model());
  MosaicOptions options = MosaicOptions::of_tiles();
  for (const double altitude_m : {2.0, 200.0}) {
    options.metres_per_pixel = altitude_m > 2.0 ? 2e-3 : 1e-7;
    const MosaicPlan plan =
        plan_mosaic(camera, std::vector<PlacedPicture>{{0, 2.0, {}}, {1, altitude_m, {}}}, options);
    // That of the second, in which the first lies.
    EXPECT_NEAR(plan.size.area(), 64e6, 0.1e6);
  }
}

TEST(MosaicTiles, RefusesTooMany) {
  const KnownFloor floor(Camera(full_model()), legs(1));
  MosaicOptions options = MosaicOptions::of_tiles();
  options.metres_per_pixel = 1e-3;
  const MosaicPlan plan = plan_mosaic(floor.camera(), floor.truth(), options);
  EXPECT_THAT(test::input_error_of(
                  [&] { make_tiles(floor, plan, {.side_px = 1}, [](const MosaicTile&) {}); }),
              testing::HasSubstr("more than 400000 tiles of 1 pixels a side"));
}

TEST(MosaicTiles, RefusesNone) {
  const KnownFloor floor(Camera(full_model()), legs(1));
  const MosaicPlan plan = plan_mosaic(floor.camera(), floor.truth(), {});
  EXPECT_THAT(test::input_error_of(
                  [&] { make_tiles(floor, plan, {.side_px = 0}, [](const MosaicTile&) {}); }),
              testing::HasSubstr("one pixel"));
}

}  // namespace
}  // namespace fathom
