// Means of a floor over the pixels of a view against the textbook: double precision, one sample
// after the other, places clamped to the floor.

#include "src/datasets/simulated/floor_lookup.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "src/datasets/simulated/floor_renderer.hpp"

namespace fathom {
namespace {

cv::Mat random_floor(cv::Size size) {
  RandomStream stream(7, "floor");
  cv::Mat_<uchar> floor(size);
  for (uchar& pixel : floor) pixel = static_cast<uchar>(stream.uniform(0.0, 256.0));
  return floor;
}

double textbook_grey(const cv::Mat& floor, const Eigen::Vector2d& place) {
  const double x = std::clamp(place.x(), 0.0, floor.cols - 1.0);
  const double y = std::clamp(place.y(), 0.0, floor.rows - 1.0);
  double grey = 0.0;
  for (const int row : {0, 1}) {
    for (const int column : {0, 1}) {
      const int u = static_cast<int>(x) + column;
      const int v = static_cast<int>(y) + row;
      const double weight = (1.0 - std::abs(x - u)) * (1.0 - std::abs(y - v));
      if (weight > 0.0) grey += weight * floor.at<uchar>(v, u);
    }
  }
  return grey;
}

double textbook_mean(const cv::Mat& floor, const Eigen::Vector2d& base, const Eigen::Matrix2d& A,
                     const Eigen::Vector2d& corner) {
  constexpr int kAcross = FloorRenderer::kSamplesAcross;
  double sum = 0.0;
  for (int j = 0; j < kAcross; ++j) {
    for (int i = 0; i < kAcross; ++i) {
      const Eigen::Vector2d within((i + 0.5) / kAcross, (j + 0.5) / kAcross);
      sum += textbook_grey(floor, base + A * (corner + within));
    }
  }
  return sum / (kAcross * kAcross);
}

// Rows of 1 to 75 pixels: less than a block of them, some blocks, and what is left over.
class FloorLookupRows : public testing::TestWithParam<int> {};

TEST_P(FloorLookupRows, AreTheMeansOfTheFloorInsideAcrossItsBorderAndBeyond) {
  const int pixels = GetParam();
  const cv::Mat floor = random_floor({90, 70});
  Eigen::Matrix2d A;
  A << 1.9, -0.8, 0.8, 1.9;
  int beyond = 0;
  for (const Eigen::Vector2d& base :
       {Eigen::Vector2d(20.3, 8.6), Eigen::Vector2d(-30.7, 40.2), Eigen::Vector2d(60.5, -60.1)}) {
    const FloorLookup lookup(area_pyramid(floor), base, A, 2.1);
    FloorLookup::Places upper(static_cast<std::size_t>(pixels) + 1);
    FloorLookup::Places lower = upper;
    for (int v = 0; v < 20; ++v) {
      for (int u = 0; u <= pixels; ++u) {
        const auto at = static_cast<std::size_t>(u);
        const Eigen::Vector2f above = lookup.place(Eigen::Vector2i(u, v).cast<float>());
        const Eigen::Vector2f below = lookup.place(Eigen::Vector2i(u, v + 1).cast<float>());
        upper.x[at] = above.x();
        upper.y[at] = above.y();
        lower.x[at] = below.x();
        lower.y[at] = below.y();
      }
      std::vector<float> means(static_cast<std::size_t>(pixels) + 1, -1.0F);
      lookup.means(upper, lower, means.data());
      for (int u = 0; u < pixels; ++u) {
        EXPECT_NEAR(means[static_cast<std::size_t>(u)],
                    textbook_mean(floor, base, A, Eigen::Vector2d(u, v)), 2e-2)
            << u << " " << v << " from " << base.transpose();
        const Eigen::Vector2d place = base + A * Eigen::Vector2d(u, v);
        const bool is_beyond =
            place.x() < 0.0 || place.y() < 0.0 || place.x() > 90.0 || place.y() > 70.0;
        beyond += is_beyond ? 1 : 0;
      }
      EXPECT_EQ(means.back(), -1.0F) << "beyond the row nothing is written";
    }
  }
  EXPECT_GT(beyond, pixels) << "the test sees the border";
}

INSTANTIATE_TEST_SUITE_P(Lengths, FloorLookupRows, testing::Values(1, 31, 32, 33, 75));

}  // namespace
}  // namespace fathom
