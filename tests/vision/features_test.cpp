#include "fathom/vision/features.hpp"

#include <algorithm>
#include <cmath>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "vision/textured_picture.hpp"

namespace fathom {
namespace {

using test::picture;

FeatureOptions options_of(const std::string& type, int max_features = 2000) {
  FeatureOptions options;
  options.type = type;
  options.max_features = max_features;
  return options;
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

TEST_P(EveryDetector, KeepsNoneNearWhatIsMasked) {
  const FeatureExtractor extractor(options_of(GetParam().name, 100));
  cv::Mat mask(picture().size(), CV_8U, cv::Scalar(255));
  EXPECT_TRUE(equal(extractor.extract(picture(), {}), extractor.extract(picture())));
  mask.rowRange(0, mask.rows / 2).setTo(0);
  const Features features = extractor.extract(picture(), mask);
  // As many as without one: the strongest of those that are left.
  EXPECT_EQ(features.size(), 100u);
  for (std::size_t i = 0; i < features.size(); ++i) {
    EXPECT_GT(features.pixels[i].y(), mask.rows / 2.0 - 2.0 + features.sizes_px[i]);
  }
  mask.setTo(0);
  EXPECT_EQ(extractor.extract(picture(), mask).size(), 0u);
  EXPECT_THROW(extractor.extract(picture(), mask.rowRange(0, 9)), InputError);
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
