#include "fathom/vision/matching.hpp"

#include <cmath>
#include <limits>
#include <set>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/features2d.hpp>

#include "fathom/core/random.hpp"
#include "vision/textured_floor.hpp"

namespace fathom {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;
using ::testing::UnorderedElementsAreArray;

Features with_descriptors(const cv::Mat& descriptors) {
  Features features;
  features.pixels.resize(static_cast<std::size_t>(descriptors.rows));
  features.descriptors = descriptors;
  return features;
}

// Whole numbers 0..255, half of them slight changes of rows of `like`, some of them repeated.
cv::Mat random_descriptors(int rows, int columns, int type, std::uint64_t seed,
                           const cv::Mat& like = {}) {
  RandomStream random(seed);
  cv::Mat result(rows, columns, CV_32F);
  for (int row = 0; row < rows; ++row) {
    const bool copies = !like.empty() && random.uniform() < 0.5;
    const int source =
        copies ? static_cast<int>(random.index(static_cast<unsigned>(like.rows))) : 0;
    const double change = copies ? random.uniform(0.0, 0.6) : 1.0;
    for (int column = 0; column < columns; ++column) {
      float value = static_cast<float>(random.index(256));
      if (copies && random.uniform() >= change) {
        value =
            type == CV_8U ? like.at<unsigned char>(source, column) : like.at<float>(source, column);
      }
      result.at<float>(row, column) = value;
    }
    if (row > 0 && row % 7 == 0) result.row(row - 1).copyTo(result.row(row));
  }
  result.convertTo(result, type);
  return result;
}

// The textbook way: OpenCV's brute force, two nearest, ratio, and back again.
std::vector<Match> by_opencv(const cv::Mat& from, const cv::Mat& to,
                             const MatchingOptions& options) {
  const cv::BFMatcher matcher(from.type() == CV_32F ? cv::NORM_L2 : cv::NORM_HAMMING);
  std::vector<std::vector<cv::DMatch>> nearest;
  std::vector<std::vector<cv::DMatch>> back;
  matcher.knnMatch(from, to, nearest, 2);
  matcher.knnMatch(to, from, back, 1);
  std::vector<Match> matches;
  for (const std::vector<cv::DMatch>& found : nearest) {
    const cv::DMatch& m = found.at(0);
    if (options.ratio < 1.0 && !(m.distance < options.ratio * found.at(1).distance)) continue;
    const bool mutual = back[static_cast<std::size_t>(m.trainIdx)].at(0).trainIdx == m.queryIdx;
    if (options.mutual && !mutual) continue;
    matches.push_back({m.queryIdx, m.trainIdx, m.distance});
  }
  return matches;
}

void expect_as_opencv(const cv::Mat& from, const cv::Mat& to) {
  for (const double ratio : {0.6, 0.8, 0.95, 1.0}) {
    for (const bool mutual : {false, true}) {
      const MatchingOptions options{ratio, mutual};
      const std::vector<Match> expected = by_opencv(from, to, options);
      ASSERT_GT(expected.size(), 5U) << "nothing compared at ratio " << ratio;
      EXPECT_EQ(match(with_descriptors(from), with_descriptors(to), options), expected)
          << "ratio " << ratio << " mutual " << mutual;
    }
  }
}

TEST(Matching, WholeNumbersMatchExactlyAsOpenCvDoes) {
  const cv::Mat to = random_descriptors(257, 128, CV_32F, 1);
  expect_as_opencv(random_descriptors(301, 128, CV_32F, 2, to), to);
}

TEST(Matching, SiftOfPicturesMatchesExactlyAsOpenCvDoes) {
  const TexturedFloor floor(500, 0.005, 3);
  const Camera camera;
  const FeatureExtractor extractor;
  const Features a = extractor.extract(floor.seen(camera, {0.0, 0.0, 0.0}, 1.5));
  const Features b = extractor.extract(floor.seen(camera, {0.2, -0.1, 0.5}, 1.6));
  expect_as_opencv(a.descriptors, b.descriptors);
}

TEST(Matching, BitsMatchExactlyAsOpenCvDoes) {
  for (const int bytes : {32, 61, 64}) {  // ORB, AKAZE, BRISK
    const cv::Mat to = random_descriptors(200, bytes, CV_8U, 4);
    expect_as_opencv(random_descriptors(190, bytes, CV_8U, 5, to), to);
  }
}

TEST(Matching, DescriptorsInsideAWiderMatrixAreReadByTheirStep) {
  const cv::Mat to = random_descriptors(60, 128, CV_32F, 6);
  const cv::Mat from = random_descriptors(60, 128, CV_32F, 7, to);
  cv::Mat wide(60, 200, CV_32F, cv::Scalar(9.0));
  from.copyTo(wide.colRange(30, 158));
  EXPECT_EQ(match(with_descriptors(wide.colRange(30, 158)), with_descriptors(to), {}),
            match(with_descriptors(from), with_descriptors(to), {}));
}

TEST(Matching, NothingMatchesNothing) {
  const Features some = with_descriptors(random_descriptors(5, 128, CV_32F, 8));
  EXPECT_THAT(match(Features{}, Features{}, {}), IsEmpty());
  EXPECT_THAT(match(some, Features{}, {}), IsEmpty());
  EXPECT_THAT(match(Features{}, some, {}), IsEmpty());
}

TEST(Matching, ASingleCandidateIsNotDistinct) {
  const Features three = with_descriptors((cv::Mat_<float>(3, 1) << 5, 9, 30));
  const Features one = with_descriptors((cv::Mat_<float>(1, 1) << 8));
  EXPECT_THAT(match(three, one, {0.99, true}), IsEmpty());
  EXPECT_THAT(match(three, one, {1.0, true}), ElementsAre(Match{1, 0, 1.0F}));
  EXPECT_THAT(match(three, one, {1.0, false}),
              ElementsAre(Match{0, 0, 3.0F}, Match{1, 0, 1.0F}, Match{2, 0, 22.0F}));
  EXPECT_THAT(match(one, three, {0.8, true}), ElementsAre(Match{0, 1, 1.0F}));
}

TEST(Matching, RatioIsStrict) {
  // d₁ = 4, d₂ = 5: exactly the ratio, so not below it.
  const Features from = with_descriptors((cv::Mat_<float>(1, 1) << 10));
  const Features to = with_descriptors((cv::Mat_<float>(2, 1) << 6, 15));
  EXPECT_THAT(match(from, to, {0.8, true}), IsEmpty());
  EXPECT_THAT(match(from, to, {0.81, true}), ElementsAre(Match{0, 0, 4.0F}));
}

TEST(Matching, EqualCandidatesAreNoMatchUnlessTheRatioIsOff) {
  const Features from = with_descriptors((cv::Mat_<float>(1, 1) << 10));
  const Features to = with_descriptors((cv::Mat_<float>(3, 1) << 20, 10, 10));
  EXPECT_THAT(match(from, to, {0.8, true}), IsEmpty());
  EXPECT_THAT(match(from, to, {1.0, true}), ElementsAre(Match{0, 1, 0.0F}));
}

TEST(Matching, ADescriptorThatIsNoNumberMatchesNothing) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Features broken = with_descriptors((cv::Mat_<float>(2, 1) << nan, 7));
  const Features whole = with_descriptors((cv::Mat_<float>(2, 1) << 100, 8));
  EXPECT_THAT(match(broken, whole, {1.0, true}), ElementsAre(Match{1, 1, 1.0F}));
  EXPECT_THAT(match(whole, broken, {1.0, true}), ElementsAre(Match{1, 1, 1.0F}));
}

TEST(Matching, DifferentKindsAreRefused) {
  const Features sift = with_descriptors(random_descriptors(5, 128, CV_32F, 8));
  const Features orb = with_descriptors(random_descriptors(5, 32, CV_8U, 8));
  const Features brisk = with_descriptors(random_descriptors(5, 64, CV_8U, 8));
  EXPECT_THROW(match(sift, orb, {}), InputError);
  EXPECT_THROW(match(orb, brisk, {}), InputError);
  const Features doubles = with_descriptors(cv::Mat::zeros(5, 128, CV_64F));
  EXPECT_THROW(match(doubles, doubles, {}), InputError);
}

// The nearest row of `to` by a double loop over doubles; of equally near ones the first.
Nearest nearest_by_loop(const cv::Mat& row, const cv::Mat& to) {
  Nearest nearest;
  for (int k = 0; k < to.rows; ++k) {
    double cost = 0.0;
    for (int column = 0; column < to.cols; ++column) {
      if (to.type() == CV_32F) {
        const double step = double(row.at<float>(0, column)) - double(to.at<float>(k, column));
        cost += step * step;
      } else {
        const int differing = row.at<unsigned char>(0, column) ^ to.at<unsigned char>(k, column);
        cost += __builtin_popcount(static_cast<unsigned>(differing));
      }
    }
    const auto distance = static_cast<float>(to.type() == CV_32F ? std::sqrt(cost) : cost);
    if (distance >= nearest.distance) continue;
    nearest.row = k;
    nearest.distance = distance;
  }
  return nearest;
}

void expect_nearest_by_loop(const cv::Mat& from, const cv::Mat& to) {
  const NearestRows rows = find_nearest(with_descriptors(from), with_descriptors(to));
  ASSERT_EQ(rows.in_to.size(), static_cast<std::size_t>(from.rows));
  ASSERT_EQ(rows.in_from.size(), static_cast<std::size_t>(to.rows));
  std::vector<Match> expected;
  std::set<std::pair<int, int>> known;
  for (int i = 0; i < from.rows; ++i) {
    const Nearest nearest = nearest_by_loop(from.row(i), to);
    EXPECT_EQ(rows.in_to[static_cast<std::size_t>(i)].row, nearest.row);
    EXPECT_FLOAT_EQ(rows.in_to[static_cast<std::size_t>(i)].distance, nearest.distance);
    expected.push_back({i, nearest.row, nearest.distance});
    known.insert({i, nearest.row});
  }
  for (int k = 0; k < to.rows; ++k) {
    const Nearest nearest = nearest_by_loop(to.row(k), from);
    EXPECT_EQ(rows.in_from[static_cast<std::size_t>(k)].row, nearest.row);
    EXPECT_FLOAT_EQ(rows.in_from[static_cast<std::size_t>(k)].distance, nearest.distance);
    if (known.insert({nearest.row, k}).second)
      expected.push_back({nearest.row, k, nearest.distance});
  }
  EXPECT_GT(expected.size(), static_cast<std::size_t>(from.rows));
  EXPECT_THAT(all_nearest(rows), UnorderedElementsAreArray(expected));
}

TEST(AllNearest, AreThoseOfADoubleLoopBothWays) {
  const cv::Mat floats = random_descriptors(130, 128, CV_32F, 11);
  expect_nearest_by_loop(random_descriptors(201, 128, CV_32F, 12, floats), floats);
  const cv::Mat bits = random_descriptors(90, 32, CV_8U, 13);
  expect_nearest_by_loop(random_descriptors(70, 32, CV_8U, 14, bits), bits);
}

TEST(AllNearest, OfASingleRowIsThatOfEveryOther) {
  const Features three = with_descriptors((cv::Mat_<float>(3, 1) << 5, 9, 30));
  const Features one = with_descriptors((cv::Mat_<float>(1, 1) << 8));
  EXPECT_THAT(all_nearest(find_nearest(one, three)),
              UnorderedElementsAre(Match{0, 0, 3.0F}, Match{0, 1, 1.0F}, Match{0, 2, 22.0F}));
  EXPECT_THAT(all_nearest(find_nearest(three, Features{})), IsEmpty());
  EXPECT_THAT(all_nearest(find_nearest(Features{}, three)), IsEmpty());
}

TEST(MatchingOptions, RefusesARatioThatIsNone) {
  MatchingOptions options;
  OptionTable table;
  options.describe(table);
  EXPECT_THROW(table.set("ratio", OptionValue::scalar("0")), InputError);
  EXPECT_THROW(table.set("ratio", OptionValue::scalar("1.2")), InputError);
  table.set("ratio", OptionValue::scalar("0.7"));
  table.set("mutual", OptionValue::scalar("false"));
  EXPECT_DOUBLE_EQ(options.ratio, 0.7);
  EXPECT_FALSE(options.mutual);
}

}  // namespace
}  // namespace fathom
