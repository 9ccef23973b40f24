// What features.flatten does to the keypoints of a picture.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/vision/features.hpp"
#include "vision/textured_picture.hpp"

namespace fathom {
namespace {

using test::picture;

// The share of the keypoints of one picture that the other one has within a pixel.
double share_found_again(const Features& some, const Features& others) {
  int found = 0;
  for (const Eigen::Vector2d& pixel : some.pixels) {
    found += std::ranges::any_of(
        others.pixels, [&](const Eigen::Vector2d& other) { return (pixel - other).norm() < 1.0; });
  }
  return found / static_cast<double>(some.size());
}

FeatureOptions flattening(bool flatten) {
  FeatureOptions options;
  options.flatten = flatten;
  options.max_features = 1000;
  return options;
}

// Of the keypoints in the plain picture, the share found again in the changed one.
double share_after(const cv::Mat& changed, bool flatten) {
  const FeatureExtractor extractor(flattening(flatten));
  return share_found_again(extractor.extract(picture()), extractor.extract(changed));
}

TEST(Flatten, ASlowLightHardlyChangesTheKeypoints) {
  // From a third of the light in one corner to all of it, as a cone about the middle of one side.
  cv::Mat lit(picture().size(), CV_8U);
  for (int v = 0; v < lit.rows; ++v) {
    for (int u = 0; u < lit.cols; ++u) {
      const double light = 0.33 + 0.67 * std::exp(-(u * u + (v - 250.0) * (v - 250.0)) / 1e5);
      lit.at<unsigned char>(v, u) =
          cv::saturate_cast<unsigned char>(light * picture().at<unsigned char>(v, u));
    }
  }
  EXPECT_GT(share_after(lit, true), 0.85);
  EXPECT_GT(share_after(lit, true), share_after(lit, false) + 0.1);
}

TEST(Flatten, LessContrastHardlyChangesTheKeypoints) {
  cv::Mat dim;
  picture().convertTo(dim, CV_8U, 0.3, 80.0);
  EXPECT_GT(share_after(dim, true), 0.85);
  // A deviation of two greys: rounding to whole ones takes some, SIFT's own threshold all.
  picture().convertTo(dim, CV_8U, 0.08, 92.0);
  EXPECT_GT(share_after(dim, true), 0.7);
  EXPECT_LT(share_after(dim, false), 0.1);
}

// Two pictures of one faint floor share their keypoints, not their noise.
double share_under_noise(bool flatten) {
  Features seen[2];
  for (const int draw : {0, 1}) {
    cv::Mat noise(picture().size(), CV_32F);
    cv::RNG(static_cast<std::uint64_t>(5 + draw)).fill(noise, cv::RNG::NORMAL, 0.0, 8.0);
    cv::Mat noisy;
    picture().convertTo(noisy, CV_32F, 0.3, 70.0);
    noisy += noise;
    noisy.convertTo(noisy, CV_8U);
    seen[draw] = FeatureExtractor(flattening(flatten)).extract(noisy);
  }
  return share_found_again(seen[0], seen[1]);
}

TEST(Flatten, KeypointsSurviveTheNoiseOfASensor) {
  EXPECT_GT(share_under_noise(true), 0.3);
  EXPECT_GT(share_under_noise(true), 1.5 * share_under_noise(false));
}

// What docs/registration.md says of a picture without noise: less the mean of means over 13 x 13
// pixels, over the root of the same mean of the squares and one grey; times 40, plus 128.
cv::Mat flattened_without_blur(const cv::Mat& gray) {
  const auto mean_of_means = [](const cv::Mat& values) {
    const cv::Mat row = cv::Mat::ones(1, 13, CV_64F) / 13.0;
    cv::Mat twice;
    cv::sepFilter2D(values, twice, CV_64F, row, row, {-1, -1}, 0.0, cv::BORDER_REFLECT_101);
    cv::sepFilter2D(twice, twice, CV_64F, row, row, {-1, -1}, 0.0, cv::BORDER_REFLECT_101);
    return twice;
  };
  cv::Mat values;
  gray.convertTo(values, CV_64F);
  const cv::Mat detail = values - mean_of_means(values);
  cv::Mat deviation;
  cv::sqrt(mean_of_means(detail.mul(detail)), deviation);
  const cv::Mat flat = detail / (deviation + 1.0);
  cv::Mat result;
  flat.convertTo(result, CV_8U, 40.0, 128.0);
  return result;
}

TEST(Flatten, ACleanFloorIsNotBlurred) {
  const Features found = FeatureExtractor(flattening(true)).extract(picture());
  const Features expected =
      FeatureExtractor(flattening(false)).extract(flattened_without_blur(picture()));
  EXPECT_GT(share_found_again(expected, found), 0.99);
  EXPECT_GT(share_found_again(found, expected), 0.99);
}

}  // namespace
}  // namespace fathom
