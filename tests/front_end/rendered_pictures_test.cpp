#include "fathom/front_end/rendered_pictures.hpp"

#include <map>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "front_end/floor_survey.hpp"

namespace fathom {
namespace {

using test::bend;
using test::FloorSurvey;

class CacheInMemory : public PictureCache {
 public:
  std::optional<std::string> find(const RegistrationKey& key) override {
    const auto at = kept.find(key);
    return at == kept.end() ? std::nullopt : std::optional(at->second);
  }
  void put(const RegistrationKey& key, std::string_view bytes) override { kept[key] = bytes; }

  std::map<RegistrationKey, std::string> kept;
};

void expect_same_pixels(const cv::Mat& one, const cv::Mat& other) {
  ASSERT_EQ(one.size(), other.size());
  ASSERT_EQ(one.type(), CV_8U);
  EXPECT_EQ(cv::norm(one, other, cv::NORM_INF), 0.0);
}

TEST(RenderedPictures, AreTakenOnceForAllSurveysThatHaveThem) {
  const FloorSurvey survey(bend(3));
  const FloorSurvey same(bend(3));
  CacheInMemory cache;
  const RenderedPictures first(survey, cache);
  const RenderedPictures second(same, cache);
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < 2; ++i) {
      const cv::Mat wanted = FloorSurvey(bend(3)).image(i);
      expect_same_pixels(first.image(i), wanted);
      expect_same_pixels(second.image(i), wanted);
      EXPECT_EQ(survey.times_taken(i), 1);
      EXPECT_EQ(same.times_taken(i), 0);
    }
  }
  expect_same_pixels(second.image(2), survey.image(2));
  EXPECT_EQ(same.times_taken(2), 1);
}

TEST(RenderedPictures, TellAPictureByItsNumber) {
  const FloorSurvey survey(bend(2));
  FloorSurvey other(bend(2));
  other.make_blank(1);
  CacheInMemory cache;
  const cv::Mat textured = RenderedPictures(survey, cache).image(1);
  expect_same_pixels(RenderedPictures(other, cache).image(1), other.image(1));
  EXPECT_GT(cv::norm(textured, other.image(1), cv::NORM_INF), 0.0);
  EXPECT_EQ(cache.kept.size(), 2U);
}

TEST(RenderedPictures, OfAnotherSizeAreTakenAgain) {
  const FloorSurvey survey(bend(1));
  CacheInMemory cache;
  const RenderedPictures rendered(survey, cache);
  const cv::Mat wanted = rendered.image(0);
  for (auto& [key, bytes] : cache.kept) bytes.pop_back();
  expect_same_pixels(rendered.image(0), wanted);
  EXPECT_EQ(survey.times_taken(0), 2);
  expect_same_pixels(rendered.image(0), wanted);
  EXPECT_EQ(survey.times_taken(0), 2);
}

TEST(RenderedPictures, WhatCannotBeTakenIsSaidAndNotKept) {
  FloorSurvey survey(bend(1));
  survey.make_unreadable(0);
  CacheInMemory cache;
  EXPECT_THROW(RenderedPictures(survey, cache).image(0), InputError);
  EXPECT_THAT(cache.kept, testing::IsEmpty());
}

TEST(RenderedPictures, AreOtherwiseTheSurvey) {
  FloorSurvey survey(bend(3));
  survey.add_odometry(Eigen::Matrix3d::Identity());
  CacheInMemory cache;
  const RenderedPictures rendered(survey, cache);
  EXPECT_EQ(rendered.size(), 3U);
  EXPECT_EQ(&rendered.camera(), &survey.camera());
  EXPECT_EQ(&rendered.info(1), &survey.info(1));
  EXPECT_EQ(rendered.picture_id(2), survey.picture_id(2));
  EXPECT_EQ(rendered.picture_name(2), survey.picture_name(2));
  EXPECT_TRUE(rendered.has_odometry());
  EXPECT_TRUE(rendered.has_ground_truth());
}

}  // namespace
}  // namespace fathom
