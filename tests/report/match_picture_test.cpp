#include "fathom/report/match_picture.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/core/random.hpp"
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
  picture.inliers = {picture.matches[0], picture.matches[2]};
  return picture;
}

TEST(MatchPicture, RawShowsAllAndAcceptedInliersAlone) {
  const cv::Mat raw = render_raw_matches(example());
  EXPECT_GT(count(raw, palette::orange), 10);
  EXPECT_GT(count(raw, palette::sky_blue), 30);
  const cv::Mat accepted = render_accepted_matches(example());
  EXPECT_EQ(count(accepted, palette::orange), 0);
  EXPECT_GT(count(accepted, palette::sky_blue), 30);
}

TEST(MatchPicture, InliersThatAreNoMatchesShowAmongTheAcceptedAlone) {
  MatchPicture picture = example();
  picture.matches.clear();
  const int no_matches = count(render_raw_matches(picture), palette::sky_blue);
  EXPECT_EQ(no_matches, 0);
  EXPECT_GT(count(render_accepted_matches(picture), palette::sky_blue), 30);
  picture = example();
  const int two = count(render_raw_matches(picture), palette::sky_blue);
  picture.inliers.push_back({{120, 20}, {130, 30}});
  EXPECT_EQ(count(render_raw_matches(picture), palette::sky_blue), two);
}

TEST(MatchPicture, ALineStartsAndEndsAtItsPixels) {
  MatchPicture picture = example();
  picture.matches = {{{100, 50}, {100, 50}}};
  picture.inliers.clear();
  const cv::Mat drawn = render_raw_matches(picture);
  const cv::Mat mask = test::where_nearly(drawn, palette::orange, 70);
  const cv::Rect box = cv::boundingRect(mask);
  // A's picture begins at (14, 64), B's 320 + 12 further on; the rings have a radius of 3.
  EXPECT_NEAR(box.x, 14 + 100 - 3, 1.5);
  EXPECT_NEAR(box.x + box.width - 1, 14 + 320 + 12 + 100 + 3, 1.5);
  EXPECT_NEAR(box.y, 64 + 50 - 3, 1.5);
  EXPECT_NEAR(box.y + box.height - 1, 64 + 50 + 3, 1.5);
}

TEST(MatchPicture, NotFoundAndNoMatchesAtAll) {
  MatchPicture picture = example();
  picture.not_found = "2 of 3 matches agree, 12 are needed";
  EXPECT_GT(count(render_accepted_matches(picture), palette::sky_blue), 30);  // the best there are
  picture.inliers.clear();
  EXPECT_EQ(count(render_raw_matches(picture), palette::sky_blue), 0);
  EXPECT_EQ(count(render_accepted_matches(picture), palette::sky_blue), 0);
  picture.matches.clear();
  EXPECT_EQ(count(render_raw_matches(picture), palette::orange), 0);
}

// 2000 matches, shifted by 60 pixels; every third one does not agree.
MatchPicture crowded() {
  MatchPicture picture;
  picture.a = cv::Mat(480, 640, CV_8UC1, cv::Scalar(120));
  picture.b = picture.a;
  RandomStream random(1, "matches");
  for (std::size_t i = 0; i < 2000; ++i) {
    const Eigen::Vector2d a(70 + random.index(560), 10 + random.index(460));
    picture.matches.push_back({a, a - Eigen::Vector2d(60, 0)});
    if (i % 3 != 0) picture.inliers.push_back(picture.matches.back());
  }
  return picture;
}

TEST(MatchPicture, ThousandsOfMatchesAreAllMarkedAndLeaveThePicturesToBeSeen) {
  const MatchPicture picture = crowded();
  const cv::Mat raw = render_raw_matches(picture);
  const cv::Mat drawn = render_accepted_matches(picture);
  for (const PixelPair& inlier : picture.inliers) {
    const Eigen::Vector2d& a = inlier.a;
    const cv::Vec3b mark =
        drawn.at<cv::Vec3b>(static_cast<int>(a.y()) + 64, static_cast<int>(a.x()) + 14);
    EXPECT_EQ(mark, cv::Vec3b(0xE9, 0xB4, 0x56)) << a.transpose();
  }
  for (const cv::Mat& any : {raw, drawn}) {
    EXPECT_GT(count(any, {120, 120, 120}), 0.5 * 2 * 640 * 480);
  }
  EXPECT_GT(count(raw, palette::orange), 1000);
  EXPECT_GT(count(raw, palette::sky_blue), 1000);
}

TEST(MatchPicture, DarkPicturesAreBrightenedAlike) {
  MatchPicture picture = example();
  picture.matches.clear();
  picture.inliers.clear();
  picture.b.setTo(cv::Scalar(40, 40, 40));
  const cv::Mat drawn = render_accepted_matches(picture);
  // 120 are wanted, 60 and 40 are there: both times 2.4.
  EXPECT_GT(count(drawn, {144, 144, 144}), 0.9 * 320 * 240);
  EXPECT_GT(count(drawn, {96, 96, 96}), 0.9 * 300 * 200);
}

TEST(MatchPicture, LargePicturesAreScaledDown) {
  MatchPicture picture = example();
  picture.a = cv::Mat(3000, 4000, CV_8UC1, cv::Scalar(10));
  picture.matches = {{{3999, 2999}, {299, 199}}};
  picture.inliers = picture.matches;
  picture.name_a = std::string(500, 'x');
  const cv::Mat drawn = render_accepted_matches(picture);
  EXPECT_LE(drawn.cols, 1640);
  EXPECT_GT(cv::countNonZero(test::where_nearly(drawn, palette::sky_blue, 40)), 200);
}

TEST(MatchPicture, Refuses) {
  MatchPicture picture = example();
  picture.b = cv::Mat();
  EXPECT_THAT(input_error_of([&] { render_raw_matches(picture); }), HasSubstr("empty"));
  picture.b = cv::Mat(10, 10, CV_16U);
  EXPECT_THAT(input_error_of([&] { render_raw_matches(picture); }), HasSubstr("got 16 bits"));
}

}  // namespace
}  // namespace fathom
