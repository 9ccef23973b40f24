#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/report/mosaic.hpp"
#include "report/level_camera.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::camera;
using test::input_error_of;
using testing::HasSubstr;

std::vector<PlacedPicture> straight(int count, double step_m) {
  std::vector<PlacedPicture> pictures;
  for (int i = 0; i < count; ++i) {
    pictures.push_back({static_cast<std::size_t>(i), 2.0, {step_m * i, 0, 0}});
  }
  return pictures;
}

TEST(MosaicPlan, APictureIsLaidEveryThirdOfAFootprintAndAtTheEnd) {
  // 0.4 m is a third of 1.2 m: frames 0, 5, 10 …, and the last.
  const MosaicPlan plan = plan_mosaic(camera(), straight(24, 0.081), {});
  std::vector<std::size_t> frames;
  for (const PlacedPicture& picture : plan.pictures) frames.push_back(picture.frame);
  EXPECT_EQ(frames, (std::vector<std::size_t>{0, 5, 10, 15, 20, 23}));
  EXPECT_EQ(plan_mosaic(camera(), straight(100, 0.0), {}).pictures.size(), 2u);
  EXPECT_EQ(plan_mosaic(camera(), straight(10, 1.0), {}).pictures.size(), 10u);
}

TEST(MosaicPlan, FillersAreLaidInGapsAlone) {
  const auto frames_of = [](double step_m) {
    std::vector<PlacedPicture> pictures = straight(16, step_m);
    for (PlacedPicture& picture : pictures) picture.is_filler = picture.frame % 5 != 0;
    std::vector<std::size_t> frames;
    for (const PlacedPicture& picture : plan_mosaic(camera(), pictures, {}).pictures) {
      frames.push_back(picture.frame);
    }
    return frames;
  };
  // Footprints of 1.2 m that are 0.9 m apart overlap by a quarter.
  EXPECT_EQ(frames_of(0.18), (std::vector<std::size_t>{0, 5, 10, 15}));
  // 1.5 m apart they do not overlap; from frame 2, 0.6 m on, they do by a quarter.
  EXPECT_EQ(frames_of(0.3), (std::vector<std::size_t>{0, 2, 5, 7, 10, 12, 15}));
}

TEST(MosaicPlan, TheEndIsCoveredByFillers) {
  std::vector<PlacedPicture> pictures = straight(21, 0.1);
  for (PlacedPicture& picture : pictures) picture.is_filler = picture.frame > 0;
  const MosaicPlan plan = plan_mosaic(camera(), pictures, {});
  // What is left at the end overlaps the last one laid by a fifth or more: 0.96 m at the most.
  EXPECT_GT(plan.top_left_m.x(), 2.0 + 0.6 - 0.96);
  EXPECT_GT(plan.pictures.size(), 2u);
}

TEST(MosaicPlan, ATurnOnTheSpotLaysPicturesToo) {
  std::vector<PlacedPicture> turning = straight(63, 0.0);
  for (std::size_t i = 0; i < turning.size(); ++i) {
    turning[i].pose.theta = 0.1 * static_cast<double>(i);
  }
  // A corner is 1 m from the middle: 0.4 m are some 0.4 rad.
  EXPECT_NEAR(static_cast<double>(plan_mosaic(camera(), turning, {}).pictures.size()), 14.0, 2.0);
}

TEST(MosaicPlan, CoversAllFootprintsOnAGridThroughTheOrigin) {
  const MosaicPlan plan = plan_mosaic(camera(), straight(3, 1.003), {});
  EXPECT_DOUBLE_EQ(plan.metres_per_pixel, 0.01);
  EXPECT_NEAR(plan.top_left_m.x(), 2.61, 1e-9);  // 2.006 + 0.6, rounded up
  EXPECT_NEAR(plan.top_left_m.y(), 0.8, 0.0101);
  EXPECT_NEAR(plan.size.height, 321, 1);
  EXPECT_NEAR(plan.size.width, 160, 2);
  const auto written = nlohmann::json::parse(mosaic_json(plan));
  EXPECT_EQ(written.at("metres_per_pixel"), plan.metres_per_pixel);
  EXPECT_EQ(written.at("x_of_top_left_m"), plan.top_left_m.x());
  EXPECT_EQ(written.at("y_of_top_left_m"), plan.top_left_m.y());
  EXPECT_EQ(written.at("pictures"), 3);
}

TEST(MosaicPlan, IsCoarserWhereItWouldBeTooLarge) {
  const auto pictures = straight(20, 1.0);
  const MosaicPlan full = plan_mosaic(camera(), pictures, {});
  EXPECT_DOUBLE_EQ(full.metres_per_pixel, full.wanted_metres_per_pixel);
  const MosaicPlan small =
      plan_mosaic(camera(), pictures, {.metres_per_pixel = {}, .most_pixels = 20'000});
  EXPECT_LE(small.size.area(), 20'000);
  EXPECT_GT(small.size.area(), 18'000);  // and no coarser than it must be
  EXPECT_DOUBLE_EQ(small.wanted_metres_per_pixel, 0.01);
  EXPECT_GT(small.metres_per_pixel, 0.03);
  const MosaicPlan asked = plan_mosaic(camera(), pictures, {.metres_per_pixel = 1e-6});
  EXPECT_LE(static_cast<double>(asked.size.width) * asked.size.height, 64e6);
  EXPECT_EQ(asked.wanted_metres_per_pixel, 1e-6);
  // A long way on the diagonal of nothing else: no side is longer than pictures may be.
  const MosaicPlan longest = plan_mosaic(camera(), straight(2000, 1.0), {});
  EXPECT_LE(longest.size.height, 65'000);
}

TEST(MosaicPlan, Refuses) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const auto error = [](const std::vector<PlacedPicture>& pictures, MosaicOptions options = {}) {
    return input_error_of([&] { plan_mosaic(camera(), pictures, options); });
  };
  EXPECT_THAT(error({}), HasSubstr("at least one picture"));
  EXPECT_THAT(error({{7, 2.0, {0, kNaN, 0}}}), HasSubstr("pose of frame 7 is not finite"));
  EXPECT_THAT(error({{7, 0.0, {}}}), HasSubstr("altitude"));
  EXPECT_THAT(error({{0, 2.0, {}}, {1, 2.0, {1e7, 0, 0}}}), HasSubstr("specks"));
  EXPECT_THAT(error({{0, 2.0, {-1e308, 0, 0}}, {1, 2.0, {1e308, 0, 0}}}), HasSubstr("specks"));
  const auto one = straight(1, 0.0);
  EXPECT_EQ(error(one), "(nothing thrown)");
  for (const double resolution : {0.0, -1.0, kNaN, HUGE_VAL}) {
    EXPECT_THAT(error(one, {.metres_per_pixel = resolution}), HasSubstr("above zero"));
  }
  EXPECT_THAT(error(one, {.metres_per_pixel = 1.0}), HasSubstr("too coarse"));
}

}  // namespace
}  // namespace fathom
