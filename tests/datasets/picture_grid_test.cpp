// Pictures of a floor must not show the grid that the floor is kept on: where this grid meets that
// of the pixels alike everywhere, features must lie as where the two meet at random.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/vision/registration.hpp"
#include "src/datasets/simulated/floor_renderer.hpp"
#include "src/datasets/simulated/sea_floor.hpp"

namespace fathom {
namespace {

constexpr double kGridAltitudeM = 2.0;

// The usual pixels, a quarter of them.
Camera small_camera() {
  CameraModel model;
  model.width = 320;
  model.height = 240;
  model.cx = 159.5;
  model.cy = 119.5;
  return Camera(model);
}

double pixel_m() {
  return finest_pixel_m(small_camera().model(), kGridAltitudeM);
}

struct Setting {
  std::string name;
  double floor_pixels;          ///< to one of the first picture
  std::optional<double> phase;  ///< of that picture on the floor's grid, floor pixels; else random
  bool turned;                  ///< headings at random, else 0
};

Setting setting_of(double floor_pixels, const std::optional<double>& phase, bool turned) {
  std::string name = floor_pixels == 2.0 ? "TwoFloorPixels" : "RootFiveFloorPixels";
  name += turned ? "Turned" : "Straight";
  name += phase ? "Phase" + std::to_string(static_cast<int>(100 * *phase)) : "Anywhere";
  return {name, floor_pixels, phase, turned};
}

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const double floor_pixels : {2.0, pixel_m() / floor_pixel_m(pixel_m())}) {
    for (const bool turned : {false, true}) {
      for (const double phase : {0.0, 0.25, 0.5}) {
        all.push_back(setting_of(floor_pixels, phase, turned));
      }
      all.push_back(setting_of(floor_pixels, std::nullopt, turned));
    }
  }
  return all;
}

World world_for(double floor_pixels) {
  const double floor_pixel = pixel_m() / floor_pixels;
  const int side = 2 * static_cast<int>(2.0 / floor_pixel) + 1;
  return {draw_sea_floor({side, side}, floor_pixel, 11), floor_pixel, {}};
}

// The first picture lies on the floor's grid as the setting says, the second anywhere, at another
// altitude.
std::pair<View, View> draw_views(const Setting& setting, double floor_pixel, RandomStream& stream) {
  const auto heading = [&] {
    return setting.turned ? stream.uniform(-std::numbers::pi, std::numbers::pi) : 0.0;
  };
  const auto on_grid = [&] {
    const double whole = std::floor(stream.uniform(-0.6, 0.6) / floor_pixel);
    return (whole + setting.phase.value_or(stream.uniform())) * floor_pixel;
  };
  View a;
  a.altitude_m = kGridAltitudeM;
  a.pose.x = on_grid();
  a.pose.y = on_grid();
  a.pose.theta = heading();
  View b;
  b.altitude_m = kGridAltitudeM * stream.uniform(0.96, 1.04);
  b.pose.x = a.pose.x + stream.uniform(-0.15, 0.15);
  b.pose.y = a.pose.y + stream.uniform(-0.15, 0.15);
  b.pose.theta = heading();
  return {a, b};
}

// Of the translation, in pixels of the first picture, in its axes.
std::vector<Eigen::Vector2d> errors_px(const Setting& setting, int pairs) {
  const Camera camera = small_camera();
  const World world = world_for(setting.floor_pixels);
  const FloorRenderer renderer(camera, ViewRays(camera), world);
  const auto features = [&](const View& view) {
    return on_floor(FeatureExtractor().extract(renderer.render(view)), camera, view.altitude_m);
  };
  RandomStream stream(5, setting.name);
  std::vector<Eigen::Vector2d> errors;
  for (int i = 0; i < pairs; ++i) {
    const auto [a, b] = draw_views(setting, world.metres_per_pixel, stream);
    const Registration result = register_pair(features(a), features(b), {}, 1);
    EXPECT_TRUE(result.found) << result.reason;
    const Pose truth = between(a.pose, b.pose);
    errors.push_back((result.motion.position() - truth.position()) / pixel_m());
  }
  return errors;
}

class PictureGrid : public testing::TestWithParam<Setting> {};

INSTANTIATE_TEST_SUITE_P(Settings, PictureGrid, testing::ValuesIn(settings()),
                         [](const auto& test_case) { return test_case.param.name; });

// An error of one registration is some 0.003 pixels, so the mean of ten is known to 0.001. With one
// sample a pixel of a floor as coarse as the picture, it is 0.014 pixels straight at a phase of ¼.
TEST_P(PictureGrid, DoesNotMoveThePictures) {
  constexpr int kPairs = 10;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Eigen::Vector2d& error : errors_px(GetParam(), kPairs)) sum += error;
  EXPECT_LT(sum.cwiseAbs().maxCoeff() / kPairs, 0.005);
}

// Kolmogorov and Smirnov's distance of two samples of sizes m and n is above 1.63 √(1/m + 1/n) with
// a probability of 1 % if both have one distribution.
TEST(PictureGridErrors, AreDistributedAlikeOnAndOffTheGrid) {
  constexpr int kPairs = 30;
  const auto lengths = [](const Setting& setting) {
    std::vector<double> all;
    for (const Eigen::Vector2d& error : errors_px(setting, kPairs)) all.push_back(error.norm());
    std::sort(all.begin(), all.end());
    return all;
  };
  const std::vector<double> on = lengths(setting_of(2.0, 0.0, true));
  const std::vector<double> off = lengths(setting_of(std::sqrt(5.0), std::nullopt, true));
  double distance = 0.0;
  for (const double at : on) {
    const auto below = std::upper_bound(off.begin(), off.end(), at) - off.begin();
    const auto own = std::upper_bound(on.begin(), on.end(), at) - on.begin();
    distance = std::max(distance, std::abs(static_cast<double>(below - own)) / kPairs);
  }
  EXPECT_LT(distance, 1.63 * std::sqrt(2.0 / kPairs));
}

// Doubling keeps where things are and straight slopes as they are.
TEST(RefinedWorld, IsTheSameFloor) {
  World world{cv::Mat(40, 60, CV_8UC1), 0.01, {}};
  for (int row = 0; row < 40; ++row) {
    for (int column = 0; column < 60; ++column) {
      world.picture.at<uchar>(row, column) = static_cast<uchar>(20 + 2 * column + row);
    }
  }
  EXPECT_EQ(refined(world, 0.02).picture.cols, 60);
  EXPECT_EQ(refined(world, 1e-6).picture.cols, 240);
  const World fine = refined(world, 0.0199);
  ASSERT_EQ(fine.picture.size(), cv::Size(120, 80));
  EXPECT_EQ(fine.metres_per_pixel, 0.005);
  for (const Eigen::Vector2d& point : {Eigen::Vector2d(0, 0), Eigen::Vector2d(0.08, -0.13)}) {
    const Eigen::Vector2d coarse = world.pixel(point);
    const Eigen::Vector2d near = fine.pixel(point).array().round();
    const Eigen::Vector2d back = (near.array() + 0.5) / 2.0 - 0.5;
    EXPECT_LT((back - coarse).norm(), 0.36);
    const double expected = 20 + 2 * back.x() + back.y();
    EXPECT_NEAR(fine.picture.at<uchar>(static_cast<int>(near.y()), static_cast<int>(near.x())),
                expected, 0.51);
  }
}

// The mean of a pixel that an edge crosses is that of the shares on either side.
TEST(AreaSampling, IsAMeanOverThePixel) {
  CameraModel model;
  model.width = model.height = 20;
  model.cx = model.cy = 9.5;
  model.fx = model.fy = 1000.0 / 3.0;
  World world{cv::Mat(801, 801, CV_8UC1, cv::Scalar(40)), 0.001, {}};
  world.picture.colRange(400, 801) = 200;
  const Camera camera(model);
  const FloorRenderer renderer(camera, ViewRays(camera), world);
  // A pixel is three of the floor's; its edge lies half of one left of the world's middle, and this
  // is where the camera's columns 9 and 10 meet. Moved to port, the camera sees it farther right.
  for (const double to_port : {0.0, 0.75, 1.5, 2.25}) {
    const cv::Mat picture = renderer.render({0, 1e-3 * to_port, 0}, 1.0);
    const double dark_share = (to_port - 0.5) / 3.0;
    EXPECT_EQ(picture.at<uchar>(10, 8), 40);
    EXPECT_NEAR(picture.at<uchar>(10, 9), 40 + 160 * std::max(-dark_share, 0.0), 8) << to_port;
    EXPECT_NEAR(picture.at<uchar>(10, 10), 200 - 160 * std::max(dark_share, 0.0), 8) << to_port;
    EXPECT_EQ(picture.at<uchar>(10, 11), 200);
  }
}

}  // namespace
}  // namespace fathom
