#include "fathom/report/match_picture.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "pixels.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::count;
using test::input_error_of;
using testing::HasSubstr;

MatchPicture example() {
  MatchPicture picture;
  picture.a = cv::Mat(240, 320, CV_8UC1, cv::Scalar(60));
  picture.b = cv::Mat(200, 300, CV_8UC3, cv::Scalar(60, 60, 60));
  picture.matches = {{{20, 30}, {50, 40}}, {{200, 100}, {210, 90}}, {{50, 200}, {250, 20}}};
  picture.inliers = {0, 2};
  return picture;
}

TEST(MatchPicture, AllMatchesAboveInliersBelow) {
  const cv::Mat drawn = render(example());
  const cv::Mat above = drawn.rowRange(0, drawn.rows / 2).clone();
  const cv::Mat below = drawn.rowRange(drawn.rows / 2, drawn.rows).clone();
  EXPECT_GT(count(above, palette::orange), 10);
  EXPECT_GT(count(above, palette::sky_blue), 30);
  EXPECT_EQ(count(below, palette::orange), 0);
  EXPECT_GT(count(below, palette::sky_blue), 30);
}

TEST(MatchPicture, ALineStartsAndEndsAtItsPixels) {
  MatchPicture picture = example();
  picture.matches = {{{100, 50}, {100, 50}}};
  picture.inliers.clear();
  const cv::Mat drawn = render(picture);
  const cv::Mat mask = test::where(drawn, palette::orange);
  std::vector<cv::Point> points;
  cv::findNonZero(mask, points);
  int leftmost = drawn.cols;
  int rightmost = 0;
  for (const cv::Point& point : points) {
    leftmost = std::min(leftmost, point.x);
    rightmost = std::max(rightmost, point.x);
  }
  // A's picture begins at 14 pixels, B's 320 + 12 further on; the rings have a radius of 3.
  EXPECT_NEAR(leftmost, 14 + 100 - 3, 1.5);
  EXPECT_NEAR(rightmost, 14 + 320 + 12 + 100 + 3, 1.5);
}

TEST(MatchPicture, NotFoundAndNoMatchesAtAll) {
  MatchPicture picture = example();
  picture.inliers.clear();
  EXPECT_EQ(count(render(picture), palette::sky_blue), 0);
  picture.matches.clear();
  EXPECT_EQ(count(render(picture), palette::orange), 0);
}

TEST(MatchPicture, LargePicturesAreScaledDown) {
  MatchPicture picture = example();
  picture.a = cv::Mat(3000, 4000, CV_8UC1, cv::Scalar(10));
  picture.matches = {{{3999, 2999}, {299, 199}}};
  picture.inliers = {0};
  picture.name_a = std::string(500, 'x');
  const cv::Mat drawn = render(picture);
  EXPECT_LE(drawn.cols, 1640);
  EXPECT_GT(count(drawn, palette::sky_blue), 30);
}

TEST(MatchPicture, Refuses) {
  MatchPicture picture = example();
  picture.inliers = {3};
  EXPECT_THAT(input_error_of([&] { render(picture); }), HasSubstr("inlier 3 is none of the 3"));
  picture = example();
  picture.b = cv::Mat();
  EXPECT_THAT(input_error_of([&] { render(picture); }), HasSubstr("empty"));
  picture.b = cv::Mat(10, 10, CV_16U);
  EXPECT_THAT(input_error_of([&] { render(picture); }), HasSubstr("got 16 bits"));
}

}  // namespace
}  // namespace fathom
