#include "fathom/vision/features.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "vision/textured_floor.hpp"

namespace fathom {
namespace {

FeatureOptions options_of(const std::string& type, int max_features = 2000) {
  FeatureOptions options;
  options.type = type;
  options.max_features = max_features;
  return options;
}

const cv::Mat& picture() {
  static const cv::Mat texture = TexturedFloor(500, 0.005, 11).picture();
  return texture;
}

bool equal(const Features& a, const Features& b) {
  return a.pixels == b.pixels && a.descriptors.size == b.descriptors.size &&
         a.descriptors.type() == b.descriptors.type() &&
         (a.size() == 0 || cv::norm(a.descriptors, b.descriptors, cv::NORM_INF) == 0.0);
}

class EveryDetector : public ::testing::TestWithParam<DetectorEntry> {};

INSTANTIATE_TEST_SUITE_P(Features, EveryDetector, ::testing::ValuesIn(detectors()),
                         [](const auto& entry) { return entry.param.name; });

TEST_P(EveryDetector, DescribesWhatItFindsInsideThePicture) {
  const Features features = FeatureExtractor(options_of(GetParam().name)).extract(picture());
  ASSERT_GT(features.size(), 100U);
  EXPECT_EQ(features.descriptors.rows, static_cast<int>(features.size()));
  EXPECT_EQ(features.descriptors.type(), GetParam().name == "sift" ? CV_32F : CV_8U);
  for (const Eigen::Vector2d& pixel : features.pixels) {
    EXPECT_GE(pixel.minCoeff(), -0.5);
    EXPECT_LE(pixel.maxCoeff(), 499.5);
  }
}

TEST_P(EveryDetector, KeepsAtMostMaxFeatures) {
  for (const int limit : {1, 7, 100}) {
    const Features features =
        FeatureExtractor(options_of(GetParam().name, limit)).extract(picture());
    EXPECT_EQ(static_cast<int>(features.size()), limit);
    EXPECT_EQ(features.descriptors.rows, limit);
  }
}

TEST_P(EveryDetector, FewFeaturesAreTheStrongestOfMany) {
  // ORB shares its number among the levels of its pyramid, so fewer are not a part of more.
  if (GetParam().name == "orb") return;
  const Features many = FeatureExtractor(options_of(GetParam().name, 100000)).extract(picture());
  const Features few = FeatureExtractor(options_of(GetParam().name, 60)).extract(picture());
  ASSERT_GT(many.size(), 60U);
  EXPECT_TRUE(std::equal(few.pixels.begin(), few.pixels.end(), many.pixels.begin()));
  EXPECT_EQ(cv::norm(few.descriptors, many.descriptors.rowRange(0, 60), cv::NORM_INF), 0.0);
}

TEST_P(EveryDetector, IsTheSameWhateverTheThreads) {
  const FeatureExtractor extractor(options_of(GetParam().name));
  const int threads = cv::getNumThreads();
  cv::setNumThreads(1);
  const Features expected = extractor.extract(picture());
  cv::setNumThreads(2);
  EXPECT_TRUE(equal(extractor.extract(picture()), expected));
  std::vector<Features> found(3);
  std::vector<std::thread> callers;
  for (Features& features : found) {
    callers.emplace_back([&] { features = extractor.extract(picture()); });
  }
  for (std::thread& caller : callers) caller.join();
  for (const Features& features : found) EXPECT_TRUE(equal(features, expected));
  cv::setNumThreads(threads);
}

TEST_P(EveryDetector, FindsNothingWhereThereIsNothing) {
  const FeatureExtractor extractor(options_of(GetParam().name));
  EXPECT_EQ(extractor.extract(cv::Mat(240, 320, CV_8U, cv::Scalar(90))).size(), 0U);
  EXPECT_TRUE(extractor.extract(cv::Mat(240, 320, CV_8U, cv::Scalar(90))).descriptors.empty());
}

TEST_P(EveryDetector, SurvivesTinyAndNarrowPictures) {
  FeatureOptions options = options_of(GetParam().name);
  for (const bool clahe : {false, true}) {
    options.clahe = clahe;
    const FeatureExtractor extractor(options);
    for (const cv::Size size :
         {cv::Size(1, 1), cv::Size(5, 400), cv::Size(31, 31), cv::Size(32, 32), cv::Size(33, 33),
          cv::Size(32, 500), cv::Size(65, 40)}) {
      const Features features = extractor.extract(picture()(cv::Rect({0, 0}, size)));
      EXPECT_EQ(features.descriptors.rows, static_cast<int>(features.size())) << size;
      if (std::min(size.width, size.height) < 32) {
        EXPECT_EQ(features.size(), 0U);
      }
    }
  }
}

TEST_P(EveryDetector, APartOfAPictureIsReadAlone) {
  const FeatureExtractor extractor(options_of(GetParam().name));
  const cv::Mat part = picture()(cv::Rect(40, 60, 300, 200));
  EXPECT_TRUE(equal(extractor.extract(part), extractor.extract(part.clone())));
}

TEST(Features, SiftKeypointsTurnWithThePicture) {
  // Turned by 180°, pixel (u, v) becomes (w − 1 − u, h − 1 − v). OpenCV's own SIFT misses that by
  // half a pixel in both directions.
  const FeatureExtractor extractor;
  const Features upright = extractor.extract(picture());
  cv::Mat turned_picture;
  cv::flip(picture(), turned_picture, -1);
  const Features turned = extractor.extract(turned_picture);
  std::vector<double> du;
  std::vector<double> dv;
  for (const Eigen::Vector2d& pixel : upright.pixels) {
    for (const Eigen::Vector2d& other : turned.pixels) {
      const Eigen::Vector2d miss = Eigen::Vector2d(499.0, 499.0) - other - pixel;
      if (miss.norm() > 1.0) continue;
      du.push_back(miss.x());
      dv.push_back(miss.y());
    }
  }
  ASSERT_GT(du.size(), 500U);
  const auto median = [](std::vector<double>& values) {
    std::ranges::nth_element(values,
                             values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2));
    return values[values.size() / 2];
  };
  EXPECT_NEAR(median(du), 0.0, 0.02);
  EXPECT_NEAR(median(dv), 0.0, 0.02);
}

TEST(Features, ClaheFindsMoreWhereContrastIsLow) {
  cv::Mat dim;
  picture().convertTo(dim, CV_8U, 0.15, 100.0);
  FeatureOptions options;
  options.flatten = false;  // which evens out contrast on its own
  const std::size_t plain = FeatureExtractor(options).extract(dim).size();
  options.clahe = true;
  EXPECT_GT(FeatureExtractor(options).extract(dim).size(), plain + 100);
}

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

TEST(Features, RefusesWhatIsNoGrayPicture) {
  const FeatureExtractor extractor;
  EXPECT_THROW(extractor.extract(cv::Mat()), InputError);
  EXPECT_THROW(extractor.extract(cv::Mat::zeros(100, 100, CV_8UC3)), InputError);
  EXPECT_THROW(extractor.extract(cv::Mat::zeros(100, 100, CV_16U)), InputError);
  EXPECT_THROW(extractor.extract(cv::Mat::zeros(100, 100, CV_32F)), InputError);
}

TEST(Features, PointsOnTheFloorGrowWithTheAltitude) {
  Features features;
  features.pixels = {{319.5, 239.5}, {419.5, 239.5}, {0.0, 479.0}};
  const Camera camera;
  const FloorFeatures low = on_floor(features, camera, 1.5);
  const FloorFeatures high = on_floor(features, camera, 3.0);
  ASSERT_EQ(low.size(), 3U);
  EXPECT_NEAR((low.points[1] - Eigen::Vector2d(0.0, -0.3)).norm(), 0.0, 1e-12);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR((high.points[i] - 2.0 * low.points[i]).norm(), 0.0, 1e-12);
  }
  EXPECT_EQ(high.features.pixels, features.pixels);
  EXPECT_THROW(on_floor(features, camera, 0.0), InputError);
}

TEST(FeatureOptions, AreSetByTheirKeys) {
  FeatureOptions options;
  OptionTable table;
  options.describe(table);
  table.set("type", OptionValue::scalar("brisk"));
  table.set("max_features", OptionValue::scalar("300"));
  table.set("clahe", OptionValue::scalar("true"));
  table.set("flatten", OptionValue::scalar("false"));
  EXPECT_EQ(options.type, "brisk");
  EXPECT_EQ(options.max_features, 300);
  EXPECT_TRUE(options.clahe);
  EXPECT_FALSE(options.flatten);
  EXPECT_THROW(table.set("type", OptionValue::scalar("surf")), InputError);
  EXPECT_THROW(table.set("max_features", OptionValue::scalar("0")), InputError);
}

}  // namespace
}  // namespace fathom
