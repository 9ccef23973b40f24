#include "fathom/report/mosaic.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "known_floor.hpp"

namespace fathom {
namespace {

using test::floor_grey;
using test::full_model;
using test::KnownFloor;
using test::legs;
using test::plain_model;

struct Made {
  MosaicPlan plan;
  cv::Mat picture;
};

Made made(const FrameSource& source, const std::vector<PlacedPicture>& placed,
          const MosaicOptions& options = {}) {
  Made result{plan_mosaic(source.camera(), placed, options), {}};
  result.picture = make_mosaics(source, {&result.plan, 1}).front();
  return result;
}

// x up and y to the left from the top left corner, written out once more.
Eigen::Vector2d world_of(const MosaicPlan& plan, int row, int column) {
  return {plan.top_left_m.x() - (row + 0.5) * plan.metres_per_pixel,
          plan.top_left_m.y() - (column + 0.5) * plan.metres_per_pixel};
}

struct Difference {
  double mean = 0.0;
  double largest = 0.0;
  int pixels = 0;
};

// From the floor itself, at every pixel that a picture shows; `scale` is what the light leaves.
Difference from_floor(const Made& mosaic, double scale = 1.0) {
  Difference difference;
  for (int v = 0; v < mosaic.picture.rows; ++v) {
    for (int u = 0; u < mosaic.picture.cols; ++u) {
      const unsigned char grey = mosaic.picture.at<unsigned char>(v, u);
      if (grey == kUnseen) continue;
      const double error = std::abs(grey - scale * floor_grey(world_of(mosaic.plan, v, u)));
      difference.mean += error;
      difference.largest = std::max(difference.largest, error);
      ++difference.pixels;
    }
  }
  difference.mean /= difference.pixels;
  return difference;
}

TEST(Mosaic, OfTheTrueTrajectoryIsTheFloor) {
  for (const CameraModel& model : {plain_model(), full_model()}) {
    const KnownFloor floor(Camera(model), legs(5));
    for (const double metres_per_pixel : {0.017, 0.01, 0.05}) {
      const Made mosaic = made(floor, floor.truth(), {.metres_per_pixel = metres_per_pixel});
      const Difference difference = from_floor(mosaic);
      EXPECT_LT(difference.mean, 1.0) << metres_per_pixel;
      EXPECT_LT(difference.largest, 6.0) << metres_per_pixel;
      // 5 legs of 4 m, half a metre apart, and what a picture sees to all sides.
      const double area_m2 = difference.pixels * metres_per_pixel * metres_per_pixel;
      EXPECT_GT(area_m2, 16.0);
      EXPECT_LT(area_m2, 36.0);
    }
  }
}

TEST(Mosaic, OfAFisheyeIsTheFloorAsFineAsOnItsAxis) {
  CameraModel model = full_model();
  model.distortion_model = DistortionModel::equidistant;
  model.distortion = {0.02, -0.01, 0.003, 0.0};
  const KnownFloor floor(Camera(model), legs(5));
  const Made mosaic = made(floor, floor.truth());
  EXPECT_NEAR(mosaic.plan.metres_per_pixel, 2.0 / std::sqrt(120.0 * 125.0), 1e-3);
  const Difference difference = from_floor(mosaic);
  EXPECT_LT(difference.mean, 1.0);
  EXPECT_LT(difference.largest, 6.0);
}

TEST(Mosaic, AheadIsUpAndPortIsLeft) {
  const KnownFloor floor(Camera(plain_model()), legs(5));
  const Made mosaic = made(floor, floor.truth(), {.metres_per_pixel = 0.02});
  cv::Mat seen = mosaic.picture.clone();
  seen.setTo(120, mosaic.picture == kUnseen);
  cv::Point darkest;
  cv::Point brightest;
  cv::minMaxLoc(seen, nullptr, nullptr, &darkest, &brightest);
  EXPECT_LT(brightest.y, darkest.y - 60);  // 2 m further ahead, 100 pixels; waves shift it a bit
  EXPECT_LT(darkest.x, brightest.x - 50);  // 1.5 m further to port, 75 pixels
  const Eigen::Vector2d bright_m = world_of(mosaic.plan, brightest.y, brightest.x);
  EXPECT_LT((bright_m - Eigen::Vector2d(2, 0)).norm(), 0.15);
}

TEST(Mosaic, AGapIsUnseenAndTheLegsAreWithoutHoles) {
  std::vector<PlacedPicture> truth;
  for (const double start_m : {0.0, 10.0}) {
    for (int i = 0; i < 40; ++i) truth.push_back({truth.size(), 2.0, {start_m + 0.1 * i, 0, 0}});
  }
  const KnownFloor floor(Camera(plain_model()), truth);
  const Made mosaic = made(floor, truth, {.metres_per_pixel = 0.02});
  // A footprint is 1.5 m long and 2 m wide: x from −0.75 to 4.65 and from 9.25 to 14.65.
  for (int v = 0; v < mosaic.picture.rows; ++v) {
    const double x = world_of(mosaic.plan, v, 0).x();
    const bool is_seen = (x > -0.72 && x < 4.62) || (x > 9.28 && x < 14.62);
    const bool is_gap = x > 4.69 && x < 9.21;
    const unsigned char grey = mosaic.picture.at<unsigned char>(v, mosaic.picture.cols / 2);
    if (is_seen) {
      EXPECT_NE(grey, kUnseen) << x;
    }
    if (is_gap) {
      EXPECT_EQ(grey, kUnseen) << x;
    }
  }
}

TEST(Mosaic, AWrongTrajectoryIsSeen) {
  const KnownFloor floor(Camera(plain_model()), legs(5));
  const Difference right = from_floor(made(floor, floor.truth()));
  std::vector<PlacedPicture> wrong = floor.truth();
  for (PlacedPicture& picture : wrong) {
    picture.pose.x += 0.2 * static_cast<double>(picture.frame / 11);  // from leg to leg
  }
  EXPECT_GT(from_floor(made(floor, wrong)).mean, 5.0 * right.mean + 2.0);
}

TEST(Mosaic, TwoPicturesInTheSamePlaceAreAveragedAndNotPicked) {
  // The second one is placed where the first one is, and shows the bright blob.
  const std::vector<PlacedPicture> truth{{0, 2.0, {0, 0, 0}}, {1, 2.0, {2, 0, 0}}};
  const KnownFloor floor(Camera(plain_model()), truth);
  std::vector<PlacedPicture> wrong = truth;
  wrong[1].pose = {0, 0, 0};
  const Made mosaic = made(floor, wrong);
  const double first = floor_grey({0, 0});
  const double second = floor_grey({2, 0});
  ASSERT_GT(std::abs(first - second), 40.0);
  const int row = static_cast<int>(mosaic.plan.top_left_m.x() / mosaic.plan.metres_per_pixel);
  const int column = static_cast<int>(mosaic.plan.top_left_m.y() / mosaic.plan.metres_per_pixel);
  EXPECT_NEAR(mosaic.picture.at<unsigned char>(row, column), 0.5 * (first + second), 3.0);
}

TEST(Mosaic, PicturesFromHighAndLowLieOnOneAnother) {
  std::vector<PlacedPicture> truth = legs(3);
  for (PlacedPicture& picture : truth) {
    if (picture.frame % 4 == 0) picture.stance = 5.0;
  }
  const KnownFloor floor(Camera(plain_model()), truth);
  const Made mosaic = made(floor, truth);
  EXPECT_LT(from_floor(mosaic).mean, 2.0);
  // Those from 2 m are more: their pixels say how fine the mosaic is.
  EXPECT_NEAR(mosaic.plan.metres_per_pixel, 2.0 / 120, 0.2 / 120);
}

TEST(Mosaic, OfTiltedPicturesIsTheFloor) {
  for (const CameraModel& model : {plain_model(), full_model()}) {
    std::vector<PlacedPicture> truth = legs(3);
    for (PlacedPicture& picture : truth) {
      const auto i = static_cast<double>(picture.frame);
      picture.stance.tilt = {0.1 * std::sin(1.3 * i), 0.1 * std::cos(0.9 * i)};
    }
    const KnownFloor floor(Camera(model), truth);
    const Difference measured = from_floor(made(floor, truth));
    EXPECT_LT(measured.mean, 1.0);
    EXPECT_LT(measured.largest, 8.0);
    std::vector<PlacedPicture> level = truth;
    for (PlacedPicture& picture : level) picture.stance.tilt = {};
    EXPECT_GT(from_floor(made(floor, level)).mean, 5.0 * measured.mean);
  }
}

// Darker towards the corners, where 45 % of the light arrive.
double vignette(const Eigen::Vector2d& pixel) {
  const double r2 = (pixel - Eigen::Vector2d(59.5, 44.5)).squaredNorm() / (75.0 * 75.0);
  return 1.0 - 0.55 * r2;
}

TEST(Mosaic, VignettingIsTakenOut) {
  const KnownFloor floor(Camera(plain_model()), legs(9), vignette);
  const Made mosaic = made(floor, floor.truth());
  double mean_light = 0.0;
  for (int v = 0; v < 90; ++v) {
    for (int u = 0; u < 120; ++u) mean_light += vignette(Eigen::Vector2d(u, v)) / (90 * 120);
  }
  // Without correction a corner is off by some 45 grey levels, and by 10 in the mean.
  EXPECT_LT(from_floor(mosaic, mean_light).mean, 2.5);
}

TEST(Mosaic, AFewPicturesTellNothingOfTheLight) {
  for (const std::size_t count : {std::size_t{1}, std::size_t{2}}) {
    std::vector<PlacedPicture> truth;
    for (std::size_t i = 0; i < count; ++i) {
      truth.push_back({i, 2.0, {3.0 * static_cast<double>(i), 0, 0}});
    }
    const KnownFloor floor(Camera(plain_model()), truth);
    EXPECT_LT(from_floor(made(floor, truth)).mean, 1.0) << count;
  }
}

TEST(Mosaic, SeveralAtOnceAreThoseMadeAlone) {
  const KnownFloor floor(Camera(plain_model()), legs(3));
  std::vector<PlacedPicture> shifted = floor.truth();
  for (PlacedPicture& picture : shifted) picture.pose.x += 1.0;
  const std::vector<MosaicPlan> plans{plan_mosaic(floor.camera(), floor.truth(), {}),
                                      plan_mosaic(floor.camera(), shifted, {})};
  std::size_t told = 0;
  const std::vector<cv::Mat> both =
      make_mosaics(floor, plans, [&](std::size_t done, std::size_t of) {
        EXPECT_EQ(done, told++);                  // from 0 on, before the first is read
        EXPECT_EQ(of, plans[0].pictures.size());  // each read once, for both
      });
  ASSERT_EQ(both.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const cv::Mat alone = make_mosaics(floor, {&plans[i], 1}).front();
    EXPECT_EQ(cv::norm(both[i], alone, cv::NORM_INF), 0.0) << i;
  }
  EXPECT_EQ(told, plans[0].pictures.size() + 1);
  EXPECT_TRUE(make_mosaics(floor, {}).empty());
}

}  // namespace
}  // namespace fathom
