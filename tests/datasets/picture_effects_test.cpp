// Each effect against its closed form, on floors of which all is known.

#include "src/datasets/simulated/picture_effects.hpp"

#include <cmath>
#include <numbers>
#include <set>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "flat_world.hpp"
#include "same_picture.hpp"
#include "src/datasets/simulated/sea_floor.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::grey_world;
using test::renderer_of;
using test::same;

const View kView{{0.1, -0.2, 0.4}, 2.0, {}, 0.0, 3};

World textured_world() {
  return {draw_sea_floor({1100, 1100}, 0.005, 3), 0.005, {}};
}

TEST(PictureEffects, NoneLeaveAPictureAsItIs) {
  const FloorRenderer renderer = renderer_of(textured_world());
  EXPECT_FALSE(PictureEffects().any());
  EXPECT_TRUE(same(renderer.render(kView), renderer.render(kView.pose, kView.altitude_m)));
}

// I = J t + B (1 − t), t = exp(−c r): in the middle r is the altitude, at a corner it is longer by
// √(1 + 0.639² + 0.479²).
TEST(PictureEffects, HazeIsThatOfTheLengthOfThePath) {
  PictureEffects effects;
  effects.water.attenuation_per_m = attenuation_of(0.6, 2.0);
  effects.water.backscatter = 200;
  const cv::Mat picture = renderer_of(grey_world(100)).render(kView, effects);
  EXPECT_NEAR(picture.at<uchar>(239, 319), 100 * 0.6 + 200 * 0.4, 0.51);
  const double t = std::pow(0.6, std::sqrt(1 + 0.639 * 0.639 + 0.479 * 0.479));
  for (const int v : {0, 479}) {
    for (const int u : {0, 639}) {
      EXPECT_NEAR(picture.at<uchar>(v, u), 100 * t + 200 * (1 - t), 0.51);
    }
  }
}

TEST(PictureEffects, LightConeFallsAsAGaussianToItsShareInTheFarthestCorner) {
  CameraModel model;
  model.cx = 219.5;
  PictureEffects effects;
  effects.camera.corner_light = 0.4;
  const cv::Mat picture = renderer_of(grey_world(200), model).render(kView, effects);
  EXPECT_NEAR(picture.at<uchar>(0, 639), 200 * 0.4, 0.51);
  EXPECT_NEAR(picture.at<uchar>(239, 219), 200, 0.51);
  // Half of the way out.
  EXPECT_NEAR(picture.at<uchar>(239 - 120, 219 + 210), 200 * std::pow(0.4, 0.25), 0.6);
}

TEST(PictureEffects, ContrastIsAboutTheMean) {
  World world = grey_world(60);
  world.picture.colRange(0, 300) = 180;
  PictureEffects effects;
  effects.camera.contrast = 0.4;
  const View view{{0, 0, 0}, 2.0};
  const FloorRenderer renderer = renderer_of(world);
  const double mean = cv::mean(renderer.render(view))[0];
  const cv::Mat picture = renderer.render(view, effects);
  EXPECT_NEAR(picture.at<uchar>(100, 10), mean + 0.4 * (180 - mean), 1.0);
  EXPECT_NEAR(picture.at<uchar>(100, 630), mean + 0.4 * (60 - mean), 1.0);
}

// How wide an edge becomes: the variance of its slope along a row or column through the middle.
double edge_variance(const cv::Mat& picture, bool along_row) {
  double sum = 0, moment = 0, square = 0;
  for (int i = 100; i < 380; ++i) {
    const double step = along_row ? picture.at<uchar>(240, i + 81) - picture.at<uchar>(240, i + 80)
                                  : picture.at<uchar>(i + 1, 320) - picture.at<uchar>(i, 320);
    sum += step;
    moment += step * i;
    square += step * i * i;
  }
  return square / sum - moment * moment / (sum * sum);
}

// A line of L pixels has the variance L²/12, and sharing its points out adds 1/6.
TEST(PictureEffects, BlurWidensEdgesAcrossTheMotionAlone) {
  World upright = grey_world(20);
  upright.picture.colRange(0, 300) = 220;
  World level = grey_world(20);
  level.picture.rowRange(0, 300) = 220;
  CameraModel model;
  model.fx = model.fy = 5000;  // edges of the floor are those of its pixels: blurred themselves
  const FloorRenderer left_right = renderer_of(upright);
  const FloorRenderer ahead_behind = renderer_of(level);
  const auto widening = [](const FloorRenderer& renderer, double motion_rad, bool along_row) {
    PictureEffects effects;
    effects.camera.motion_blur_px = 9;
    const View view{{0, 0, 0}, 2.0, {}, motion_rad};
    return edge_variance(renderer.render(view, effects), along_row) -
           edge_variance(renderer.render(view), along_row);
  };
  EXPECT_NEAR(widening(ahead_behind, 0.0, false), 81.0 / 12 + 1.0 / 6, 0.25);
  EXPECT_NEAR(widening(left_right, 0.0, true), 0.0, 0.1);
  EXPECT_NEAR(widening(left_right, std::numbers::pi / 2, true), 81.0 / 12 + 1.0 / 6, 0.25);
  EXPECT_NEAR(widening(left_right, std::numbers::pi / 4, true), 81.0 / 24 + 1.0 / 6, 0.25);
}

TEST(PictureEffects, NoiseHasItsSigmaAndIsNewInEveryPicture) {
  PictureEffects effects;
  effects.camera.noise_sigma = 8;
  const FloorRenderer renderer = renderer_of(grey_world(120));
  const cv::Mat picture = renderer.render(kView, effects);
  cv::Scalar mean, sigma;
  cv::meanStdDev(picture, mean, sigma);
  // Of 307200 pixels: 0.014 and 0.010; rounding adds 1/12 to the variance.
  EXPECT_NEAR(mean[0], 120, 0.06);
  EXPECT_NEAR(sigma[0], std::sqrt(64 + 1.0 / 12), 0.05);
  View next = kView;
  next.seed = 4;
  cv::meanStdDev(picture - renderer.render(next, effects) + 128, mean, sigma);
  EXPECT_GT(cv::norm(picture, renderer.render(next, effects), cv::NORM_L2) / std::sqrt(307200.0),
            0.99 * 8 * std::numbers::sqrt2);
}

TEST(PictureEffects, ParticlesBrightenALittleOfThePicture) {
  PictureEffects effects;
  effects.water.particles = 40;
  const FloorRenderer renderer = renderer_of(grey_world(120));
  const auto covered = [&](std::uint64_t seed) {
    View view = kView;
    view.seed = seed;
    const cv::Mat picture = renderer.render(view, effects);
    EXPECT_EQ(cv::countNonZero(picture < 120), 0);
    return cv::Mat(picture > 121);
  };
  const cv::Mat first = covered(1);
  // Discs of 1.5 to 8 pixels in radius.
  EXPECT_GT(cv::countNonZero(first), 40 * 3);
  EXPECT_LT(cv::countNonZero(first), 40 * 64 * std::numbers::pi);
  EXPECT_LT(cv::countNonZero(first & covered(2)), cv::countNonZero(first) / 5);
}

// Each channel round(g I): 154, 110, 55; 0.299 · 154 + 0.587 · 110 + 0.114 · 55 = 116.886.
TEST(PictureEffects, ColourCastIsAGainPerChannelOf8Bits) {
  PictureEffects effects;
  effects.camera.colour_cast = {1.4, 1.0, 0.5};
  EXPECT_EQ(renderer_of(grey_world(110)).render(kView, effects).at<uchar>(7, 9), 117);
  // Red is full at 255: 0.299 · 255 + 0.587 · 240 + 0.114 · 120 = 230.805.
  EXPECT_EQ(renderer_of(grey_world(240)).render(kView, effects).at<uchar>(7, 9), 231);
}

TEST(PictureEffects, CausticsSwingByTheirShareInAPatternThatIsNewInEveryPicture) {
  PictureEffects effects;
  effects.water.caustics = 0.2;
  const FloorRenderer renderer = renderer_of(grey_world(150));
  const auto pattern = [&](std::uint64_t seed) {
    View view = kView;
    view.seed = seed;
    cv::Mat picture;
    renderer.render(view, effects).convertTo(picture, CV_32F);
    double low = 0, high = 0;
    cv::minMaxLoc(picture, &low, &high);
    EXPECT_GE(low, 120 - 0.51);
    EXPECT_LT(low, 130);
    EXPECT_GT(high, 175);
    EXPECT_LE(high, 180 + 0.51);
    EXPECT_NEAR(cv::mean(picture)[0], 150, 7);
    return cv::Mat(picture - cv::mean(picture));
  };
  double correlation = 0.0;
  for (std::uint64_t seed = 1; seed < 9; ++seed) {
    const cv::Mat a = pattern(seed);
    const cv::Mat b = pattern(seed + 8);
    correlation += a.dot(b) / std::sqrt(a.dot(a) * b.dot(b)) / 8;
  }
  EXPECT_LT(std::abs(correlation), 0.15);
}

TEST(PictureEffects, CausticsLieOnTheFloor) {
  PictureEffects effects;
  effects.water.caustics = 0.5;
  const FloorRenderer renderer = renderer_of(grey_world(120));
  const View here{{0, 0, 0}, 2.0, {}, 0.0, 1};
  const View ahead{{0.4, 0, 0}, 2.0, {}, 0.0, 1};
  // 0.4 m are 100 pixels.
  EXPECT_LE(cv::norm(renderer.render(here, effects).rowRange(0, 380),
                     renderer.render(ahead, effects).rowRange(100, 480), cv::NORM_INF),
            1.0);
}

TEST(PictureEffects, DoNotDependOnThreads) {
  PictureEffects effects;
  effects.water = {0.3, 150, 0.2, 50};
  effects.camera = {0.5, 0.7, 14.0, 4.0, {1.1, 1.0, 0.8}};
  const FloorRenderer renderer = renderer_of(textured_world());
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const cv::Mat one = renderer.render(kView, effects);
  cv::setNumThreads(2);
  const cv::Mat two = renderer.render(kView, effects);
  cv::setNumThreads(before);
  EXPECT_TRUE(same(one, two));
}

TEST(PictureEffects, RefuseWhatCannotBe) {
  const auto refused = [](auto spoil) {
    PictureEffects effects;
    spoil(effects);
    return test::input_error_of([&] { effects.check("dataset."); });
  };
  const std::string cast = "dataset.camera_effects.colour_cast: expected three gains";
  EXPECT_EQ(refused([](auto& e) { e.camera.colour_cast = {1, 1}; }).find(cast), 0U);
  EXPECT_EQ(refused([](auto& e) { e.camera.colour_cast = {1, 0, 1}; }).find(cast), 0U);
  EXPECT_EQ(refused([](auto& e) { e.camera.colour_cast = {1, 1, NAN}; }).find(cast), 0U);
  EXPECT_EQ(refused([](auto& e) {
              e.water.backscatter = 90;
            }).find("dataset.water.backscatter: has no effect in clear water"),
            0U);
  EXPECT_EQ(refused([](auto&) {}), "(nothing thrown)");
}

}  // namespace
}  // namespace fathom
