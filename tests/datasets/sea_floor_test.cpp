#include "src/datasets/simulated/sea_floor.hpp"

#include <string>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/vision/features.hpp"

namespace fathom {
namespace {

constexpr double kFloorMetresPerPixel = 0.004;

class SeaFloors : public testing::TestWithParam<std::pair<std::string, FloorKind>> {
 protected:
  static cv::Mat draw(cv::Size size, std::uint64_t seed = 7) {
    return draw_sea_floor(size, kFloorMetresPerPixel, seed, GetParam().second);
  }
};

// A picture of 640 × 480 from 2 m with f = 500 has pixels of 4 mm, those of the floor.
TEST_P(SeaFloors, HaveTextureEverywhere) {
  const std::size_t least = GetParam().second == FloorKind::mud ? 150 : 500;
  const cv::Mat floor = draw({1280, 960});
  for (int v = 0; v < floor.rows; v += 480) {
    for (int u = 0; u < floor.cols; u += 640) {
      const cv::Mat seen = floor(cv::Rect(u, v, 640, 480)).clone();
      EXPECT_GT(FeatureExtractor().extract(seen).size(), least) << u << " " << v;
    }
  }
}

TEST_P(SeaFloors, AreNeitherDarkNorOverexposed) {
  const cv::Mat floor = draw({1000, 1000});
  EXPECT_NEAR(cv::mean(floor)[0], 125, 30);
  EXPECT_LT(cv::countNonZero(floor < 10) + cv::countNonZero(floor > 250), 0.01 * 1e6);
}

TEST_P(SeaFloors, AreTheSameWithAnyNumberOfThreadsAndOtherWithAnotherSeed) {
  const int before = cv::getNumThreads();
  cv::setNumThreads(1);
  const cv::Mat one = draw({300, 400});
  cv::setNumThreads(2);
  const cv::Mat two = draw({300, 400});
  cv::setNumThreads(before);
  EXPECT_EQ(cv::norm(one, two, cv::NORM_INF), 0.0);
  EXPECT_GT(cv::norm(one, draw({300, 400}, 8), cv::NORM_INF), 20.0);
}

TEST_P(SeaFloors, OfAnySizeAndScaleCanBeDrawn) {
  EXPECT_EQ(draw({1, 1}).size(), cv::Size(1, 1));
  EXPECT_EQ(draw_sea_floor({7, 3}, 1000.0, 1, GetParam().second).size(), cv::Size(7, 3));
  EXPECT_EQ(draw_sea_floor({40, 30}, 1e-5, 1, GetParam().second).size(), cv::Size(40, 30));
}

INSTANTIATE_TEST_SUITE_P(Kinds, SeaFloors, testing::ValuesIn(floor_kinds()),
                         [](const auto& test_case) { return test_case.param.first; });

// How well the best other place agrees with a square of 0.6 m, a wavelength away or more.
double best_other_agreement(FloorKind kind) {
  cv::Mat floor = draw_sea_floor({1000, 1000}, kFloorMetresPerPixel, 8, kind);
  cv::GaussianBlur(floor, floor, cv::Size(), 3.0);
  cv::Mat agreement;
  cv::matchTemplate(floor, floor(cv::Rect(425, 425, 150, 150)), agreement, cv::TM_CCOEFF_NORMED);
  constexpr int kAway = 30;
  cv::rectangle(agreement, {425 - kAway, 425 - kAway}, {425 + kAway, 425 + kAway}, -1.0, -1);
  double best = 0.0;
  cv::minMaxLoc(agreement, nullptr, &best);
  return best;
}

TEST(SeaFloor, RipplesRepeatAndPebblesDoNot) {
  EXPECT_GT(best_other_agreement(FloorKind::ripples), 0.8);
  EXPECT_LT(best_other_agreement(FloorKind::pebbles), 0.4);
}

// Recorded from the version before there were kinds; a grey of leeway for another libm.
TEST(SeaFloor, TheMixedOneIsWhatItAlwaysWas) {
  const int recorded[] = {149, 165, 141, 124, 138, 125, 101, 152, 140, 136, 126, 129};
  const cv::Mat floor = draw_sea_floor({640, 480}, kFloorMetresPerPixel, 21);
  for (int i = 0; i < 12; ++i) {
    EXPECT_NEAR(floor.at<uchar>(17 + 37 * i, 29 + 51 * i), recorded[i], 1) << i;
  }
  EXPECT_NEAR(cv::mean(floor)[0], 130.272546, 1e-3);
}

}  // namespace
}  // namespace fathom
