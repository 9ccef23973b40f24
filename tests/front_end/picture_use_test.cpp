// What pictures of a survey say of the floor: masks, given or found, and pictures that repeat.

#include "fathom/front_end/picture_use.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/front_end/visual_odometry.hpp"
#include "fathom/vision/static_view.hpp"
#include "front_end/floor_survey.hpp"
#include "front_end/map_cache.hpp"
#include "front_end/measured_frames.hpp"

namespace fathom {
namespace {

using test::at;
using test::bend;
using test::FloorSurvey;
using test::kSeed;
using test::MapCache;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::SizeIs;

constexpr int kSkidPx = 24;

// With a part of the vehicle over the lowest of 150 rows, or a mask that is given.
class SkidSurvey : public FloorSurvey {
 public:
  using FloorSurvey::FloorSurvey;
  void give(const cv::Mat& mask) { given_ = mask; }
  cv::Mat given_mask() const override { return given_; }
  cv::Mat image(std::size_t i) const override {
    cv::Mat picture = FloorSurvey::image(i);
    cv::RNG random(3);
    cv::Mat small(kSkidPx / 4, 50, CV_8U);
    random.fill(small, cv::RNG::UNIFORM, 20, 230);
    cv::Mat skid;
    cv::resize(small, skid, {200, kSkidPx}, 0, 0, cv::INTER_NEAREST);
    skid.copyTo(picture.rowRange(150 - kSkidPx, 150));
    return picture;
  }

 private:
  cv::Mat given_;
};

// Its camera hangs: some frames have the picture of the one before.
class HangingSurvey : public FloorSurvey {
 public:
  HangingSurvey(std::size_t frames, std::size_t first, std::size_t last)
      : FloorSurvey(bend(frames)), first_(first), last_(last) {}
  std::uint64_t picture_id(std::size_t i) const override {
    return FloorSurvey::picture_id(shown(i));
  }
  cv::Mat image(std::size_t i) const override { return FloorSurvey::image(shown(i)); }

 private:
  std::size_t shown(std::size_t i) const { return i >= first_ && i <= last_ ? first_ - 1 : i; }

  std::size_t first_;
  std::size_t last_;
};

// Over 3 m and back beside it.
std::vector<Pose> there_and_back() {
  std::vector<Pose> poses;
  for (int i = 0; i < 20; ++i) poses.push_back({-1.5 + 0.15 * i, -0.8, 0.1});
  for (int i = 0; i < 20; ++i) poses.push_back({1.5 - 0.15 * i, 0.7, 3.0});
  return poses;
}

TEST(PictureUse, AllOfACleanSurveyIsUsed) {
  const FloorSurvey survey(there_and_back());
  const PictureUse use = picture_use(survey, MaskUse::automatic);
  EXPECT_TRUE(use.mask.empty());
  EXPECT_TRUE(use.is_told);
  EXPECT_THAT(use.repeats, SizeIs(0));
  EXPECT_THAT(remarks_on(use, survey), SizeIs(0));
  int taken = 0;
  for (std::size_t i = 0; i < survey.size(); ++i) taken += survey.times_taken(i);
  EXPECT_LE(taken, 8) << "half of the pictures are enough";
}

TEST(PictureUse, WhatStaysIsMaskedUnlessSwitchedOff) {
  const SkidSurvey survey(there_and_back());
  const PictureUse use = picture_use(survey, MaskUse::automatic);
  ASSERT_EQ(use.mask.size(), cv::Size(200, 150));
  EXPECT_EQ(cv::countNonZero(use.mask.rowRange(150 - kSkidPx + 4, 150)), 0);
  EXPECT_EQ(cv::countNonZero(use.mask.rowRange(0, 100)), 200 * 100);
  const auto remarks = remarks_on(use, survey);
  ASSERT_THAT(remarks, SizeIs(1));
  EXPECT_THAT(remarks.front(), HasSubstr("the lowest"));
  EXPECT_THAT(remarks.front(), HasSubstr("front_end.mask: off"));
  EXPECT_TRUE(picture_use(survey, MaskUse::off).mask.empty());
}

TEST(PictureUse, AGivenMaskWins) {
  SkidSurvey survey(there_and_back());
  cv::Mat given(150, 200, CV_8U, cv::Scalar(255));
  given(cv::Rect(0, 0, 50, 150)).setTo(0);
  survey.give(given);
  const PictureUse use = picture_use(survey, MaskUse::automatic);
  EXPECT_EQ(cv::norm(use.mask, given, cv::NORM_INF), 0.0);
  EXPECT_THAT(remarks_on(use, survey),
              ElementsAre("masked: 25 % of the picture (the leftmost 25 %), as the data set says; "
                          "front_end.mask: off switches that off"));
  for (std::size_t i = 0; i < survey.size(); ++i) EXPECT_EQ(survey.times_taken(i), 0);
  EXPECT_TRUE(picture_use(survey, MaskUse::off).mask.empty());
  survey.give(cv::Mat(150, 200, CV_8U, cv::Scalar(255)));
  EXPECT_TRUE(picture_use(survey, MaskUse::automatic).mask.empty()) << "hides nothing";
}

TEST(PictureUse, OfAVehicleAtRestNothingCanBeTold) {
  const FloorSurvey survey(std::vector<Pose>(20, Pose{0.1, 0.2, 0.3}));
  const PictureUse use = picture_use(survey, MaskUse::automatic);
  EXPECT_TRUE(use.mask.empty());
  EXPECT_FALSE(use.is_told);
}

TEST(PictureUse, PicturesThatCannotBeReadArePassedOver) {
  FloorSurvey survey(there_and_back());
  for (const std::size_t i : {1, 6, 11}) survey.make_unreadable(i);
  EXPECT_TRUE(picture_use(survey, MaskUse::automatic).mask.empty());
}

TEST(PictureUse, TheMaskIsOfTheRegistrationsAndTheirKeys) {
  const SkidSurvey survey(there_and_back());
  const PictureUse use = picture_use(survey, MaskUse::automatic);
  MapCache cache;
  PairRegistrar masked(survey, {}, {}, kSeed, &cache, PairRegistrar::kFeatureBytes, use);
  PairRegistrar plain(survey, {}, {}, kSeed, &cache);
  const PairRegistration found = masked.of(at(0), at(2));
  ASSERT_TRUE(found.found);
  EXPECT_NEAR(found.motion.x, 0.3, 0.01);
  plain.of(at(0), at(2));
  EXPECT_EQ(plain.from_cache(), 0u);
  PairRegistrar again(survey, {}, {}, kSeed, &cache, PairRegistrar::kFeatureBytes, use);
  EXPECT_EQ(again.of(at(0), at(2)), found);
  EXPECT_EQ(again.from_cache(), 1u);
}

TEST(RepeatedPictures, WithoutOdometryEveryRepetitionIsOne) {
  const HangingSurvey survey(10, 4, 6);
  std::vector<bool> expected(10, false);
  for (const std::size_t i : {4, 5, 6}) expected[i] = true;
  EXPECT_EQ(repeated_pictures(survey), expected);
  const auto remarks = remarks_on(picture_use(survey, MaskUse::off), survey);
  ASSERT_THAT(remarks, SizeIs(1));
  EXPECT_THAT(remarks.front(),
              HasSubstr("3 pictures repeat the one before them (first: 'frame 4'), no motion"));
}

TEST(RepeatedPictures, WithOdometryThoseAreThatMoved) {
  HangingSurvey moving(10, 4, 6);
  moving.add_odometry(1e-6 * Eigen::Matrix3d::Identity());
  EXPECT_THAT(repeated_pictures(moving), SizeIs(10));
  // As good as nothing is known of the motion.
  HangingSurvey unsure(10, 4, 6);
  unsure.add_odometry(Eigen::Matrix3d::Identity());
  EXPECT_THAT(repeated_pictures(unsure), SizeIs(0));
  FloorSurvey at_rest(std::vector<Pose>(10, Pose{0.1, 0.2, 0.3}));
  at_rest.add_odometry(1e-6 * Eigen::Matrix3d::Identity());
  EXPECT_THAT(repeated_pictures(at_rest), SizeIs(0));
}

TEST(RepeatedPictures, AreNoMeasurementOfMotion) {
  const HangingSurvey survey(8, 3, 4);
  const PictureUse use = picture_use(survey, MaskUse::off);
  PairRegistrar registrar(survey, {}, {}, kSeed, nullptr, PairRegistrar::kFeatureBytes, use);
  VisualOdometry odometry(survey, registrar, {});
  for (std::size_t i = 1; i < survey.size(); ++i) odometry.info(i);
  // Into either repetition, and out of the last: its picture is of another place.
  EXPECT_EQ(odometry.failures(), 3u);
  EXPECT_GT(odometry.info(3).motion->covariance(0, 0), 0.01);
  EXPECT_LT(odometry.info(6).motion->covariance(0, 0), 0.01);
  EXPECT_FALSE(registrar.of(at(2), at(3)).found);
  EXPECT_TRUE(registrar.of(at(2), at(5)).found);
}

}  // namespace
}  // namespace fathom
