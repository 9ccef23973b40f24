// Mosaics with seams: pictures at equal exposure, each point of the floor from one of them.

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/report/mosaic.hpp"
#include "known_floor.hpp"

namespace fathom {
namespace {

using test::floor_grey;
using test::KnownFloor;
using test::legs;
using test::plain_model;

// A camera whose exposure changes from picture to picture.
class FlickeringFloor : public KnownFloor {
 public:
  using KnownFloor::KnownFloor;
  cv::Mat image(std::size_t i) const override {
    const double exposure = 1.0 + 0.15 * std::sin(2.3 * static_cast<double>(i));
    return KnownFloor::image(i) * exposure;
  }
};

// A camera whose light comes from ahead in one picture and from aft in the next, so that no
// one factor makes neighbours agree.
class SlantedLight : public KnownFloor {
 public:
  using KnownFloor::KnownFloor;
  cv::Mat image(std::size_t i) const override {
    cv::Mat picture = KnownFloor::image(i);
    const double slope = (i % 2 == 0 ? 0.3 : -0.3) / picture.rows;
    for (int v = 0; v < picture.rows; ++v) {
      picture.row(v) *= 1.0 + slope * (v - 0.5 * picture.rows);
    }
    return picture;
  }
};

// A floor without anything broad.
class DetailedFloor : public KnownFloor {
 public:
  using KnownFloor::KnownFloor;
  static double grey(const Eigen::Vector2d& point) {
    return 110.0 + 40.0 * std::sin(25.0 * point.x()) * std::sin(20.0 * point.y());
  }
  cv::Mat image(std::size_t i) const override {
    cv::Mat picture(camera().model().height, camera().model().width, CV_8U);
    for (int v = 0; v < picture.rows; ++v) {
      for (int u = 0; u < picture.cols; ++u) {
        const PlacedPicture& from = truth()[i];
        const Eigen::Vector2d seen = camera().floor_point(Eigen::Vector2d(u, v), from.stance);
        picture.at<unsigned char>(v, u) =
            cv::saturate_cast<unsigned char>(grey(transform(from.pose, seen)));
      }
    }
    return picture;
  }
};

cv::Mat mosaic_of(const FrameSource& source, const std::vector<PlacedPicture>& placed,
                  MosaicBlend blend, MosaicPlan& plan) {
  plan = plan_mosaic(source.camera(), placed, {.metres_per_pixel = 0.02, .blend = blend});
  return make_mosaics(source, {&plan, 1}).front();
}

// Of mosaic over floor, which should be the same everywhere; NaN where nothing is seen.
cv::Mat light_of(const cv::Mat& mosaic, const MosaicPlan& plan) {
  cv::Mat light(mosaic.size(), CV_64F, cv::Scalar(std::nan("")));
  for (int v = 0; v < mosaic.rows; ++v) {
    for (int u = 0; u < mosaic.cols; ++u) {
      if (mosaic.at<unsigned char>(v, u) == kUnseen) continue;
      const Eigen::Vector2d point(plan.top_left_m.x() - (v + 0.5) * plan.metres_per_pixel,
                                  plan.top_left_m.y() - (u + 0.5) * plan.metres_per_pixel);
      light.at<double>(v, u) = mosaic.at<unsigned char>(v, u) / floor_grey(point);
    }
  }
  return light;
}

// The standard deviation of the light, over its mean.
double unevenness(const cv::Mat& mosaic, const MosaicPlan& plan) {
  double sum = 0.0;
  double squares = 0.0;
  double count = 0.0;
  const cv::Mat light = light_of(mosaic, plan);
  for (const double ratio : cv::Mat_<double>(light)) {
    if (std::isnan(ratio)) continue;
    sum += ratio;
    squares += ratio * ratio;
    ++count;
  }
  const double mean = sum / count;
  return std::sqrt(squares / count - mean * mean) / mean;
}

TEST(MosaicSeams, ExposureIsMadeEqual) {
  const FlickeringFloor floor(Camera(plain_model()), legs(5));
  MosaicPlan plan;
  const cv::Mat feathered = mosaic_of(floor, floor.truth(), MosaicBlend::feather, plan);
  EXPECT_GT(unevenness(feathered, plan), 0.03);
  const cv::Mat with_seams = mosaic_of(floor, floor.truth(), MosaicBlend::seams, plan);
  EXPECT_LT(unevenness(with_seams, plan), 0.02);
}

TEST(MosaicSeams, EqualExposureIsLeftAsItIs) {
  const KnownFloor floor(Camera(plain_model()), legs(5));
  MosaicPlan plan;
  const cv::Mat mosaic = mosaic_of(floor, floor.truth(), MosaicBlend::seams, plan);
  EXPECT_LT(unevenness(mosaic, plan), 0.01);
}

// Two pictures beside each other, whose light differs by a fifth along the row that is looked at.
TEST(MosaicSeams, LightThatDiffersFades) {
  const SlantedLight floor(Camera(plain_model()), {{0, 2.0, {0, 0, 0}}, {1, 2.0, {0, 1, 0}}});
  MosaicPlan plan;
  const cv::Mat mosaic = mosaic_of(floor, floor.truth(), MosaicBlend::seams, plan);
  const cv::Mat light = light_of(mosaic, plan);
  const int row = light.rows / 6;
  constexpr int kFar = 5;  // pixels
  double greatest_step = 0.0;
  for (int u = 0; u + kFar < light.cols; ++u) {
    const double step = std::abs(light.at<double>(row, u + kFar) - light.at<double>(row, u));
    greatest_step = std::max(greatest_step, step);
  }
  const double across = std::abs(light.at<double>(row, light.cols - 1) - light.at<double>(row, 0));
  EXPECT_GT(across, 0.19);
  EXPECT_LT(greatest_step, 0.05);
}

// Two pictures of one place, the second laid 0.4 m beside it: details are of one or the other.
TEST(MosaicSeams, EachPointIsOfOnePicture) {
  const DetailedFloor floor(Camera(plain_model()), {{0, 2.0, {0, 0, 0}}, {1, 2.0, {0, 0, 0}}});
  const double off_m = 0.4;
  const std::vector<PlacedPicture> wrong{{0, 2.0, {0, 0, 0}}, {1, 2.0, {0, off_m, 0}}};
  const auto share_of_one = [&](MosaicBlend blend) {
    MosaicPlan plan;
    const cv::Mat mosaic = mosaic_of(floor, wrong, blend, plan);
    int of_one = 0;
    int differing = 0;
    for (int v = 0; v < mosaic.rows; ++v) {
      for (int u = 0; u < mosaic.cols; ++u) {
        const double x = plan.top_left_m.x() - (v + 0.5) * plan.metres_per_pixel;
        const double y = plan.top_left_m.y() - (u + 0.5) * plan.metres_per_pixel;
        // Within both, and where they would show a difference.
        if (std::abs(x) > 0.7 || y > 0.9 || y < off_m - 0.9) continue;
        const double first = DetailedFloor::grey({x, y});
        const double second = DetailedFloor::grey({x, y - off_m});
        if (std::abs(first - second) < 12.0) continue;
        ++differing;
        const double grey = mosaic.at<unsigned char>(v, u);
        if (std::min(std::abs(grey - first), std::abs(grey - second)) < 4.0) ++of_one;
      }
    }
    return static_cast<double>(of_one) / differing;
  };
  EXPECT_LT(share_of_one(MosaicBlend::feather), 0.6);
  EXPECT_GT(share_of_one(MosaicBlend::seams), 0.8);
}

}  // namespace
}  // namespace fathom
