#include "fathom/front_end/feature_store.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "front_end/floor_survey.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::bend;
using test::FloorSurvey;
using test::input_error_of;
using ::testing::HasSubstr;

void expect_same(const FloorFeatures& a, const FloorFeatures& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.features.pixels, b.features.pixels);
  ASSERT_EQ(a.features.descriptors.size(), b.features.descriptors.size());
  EXPECT_EQ(cv::countNonZero(a.features.descriptors != b.features.descriptors), 0);
}

FloorFeatures extracted(const FloorSurvey& survey, std::size_t frame) {
  return on_floor(FeatureExtractor().extract(survey.image(frame)), survey.camera(),
                  survey.info(frame).altitude_m);
}

TEST(FeatureStore, GivesTheFeaturesOfTheFrame) {
  const FloorSurvey survey(bend(3));
  FeatureStore store(survey, {});
  const auto features = store.of(2);
  EXPECT_GT(features->size(), 50u);
  expect_same(*features, extracted(survey, 2));
}

TEST(FeatureStore, UsesItsOptions) {
  const FloorSurvey survey(bend(1));
  FeatureOptions options;
  options.max_features = 40;
  EXPECT_EQ(FeatureStore(survey, options).of(0)->size(), 40u);
  options.type = FeatureType::orb;
  EXPECT_EQ(FeatureStore(survey, options).of(0)->features.descriptors.type(), CV_8U);
}

TEST(FeatureStore, ExtractsOnceAsLongAsSomebodyHoldsThem) {
  const FloorSurvey survey(bend(8));
  FeatureStore store(survey, {});
  const auto held = store.of(0);
  for (std::size_t i = 1; i < 8; ++i) store.of(i);
  EXPECT_EQ(store.of(0), held);
  EXPECT_EQ(survey.times_taken(0), 1);
}

TEST(FeatureStore, KeepsTheFrameBeforeForVisualOdometry) {
  const FloorSurvey survey(bend(5));
  FeatureStore store(survey, {});
  for (std::size_t i = 1; i < 5; ++i) {
    store.announce(i + 1);
    store.of(i - 1);
    store.of(i);
  }
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(survey.times_taken(i), 1) << i;
}

TEST(FeatureStore, LetsGoOfOldFrames) {
  const FloorSurvey survey(bend(8));
  FeatureStore store(survey, {});
  const std::weak_ptr<const FloorFeatures> old = store.of(0);
  for (std::size_t i = 1; i < 8; ++i) store.of(i);
  EXPECT_TRUE(old.expired());
  EXPECT_GT(store.of(0)->size(), 50u);
}

TEST(FeatureStore, AnAnnouncedFrameIsTheSame) {
  const FloorSurvey survey(bend(3));
  FeatureStore store(survey, {});
  store.announce(2);
  store.announce(2);
  store.announce(1);
  const auto second = store.of(2);
  const auto first = store.of(1);
  EXPECT_EQ(survey.times_taken(1), 1);
  EXPECT_EQ(survey.times_taken(2), 1);
  expect_same(*second, extracted(survey, 2));
  expect_same(*first, extracted(survey, 1));
}

TEST(FeatureStore, AnnouncingWhatIsHeldOrBeyondTheEndDoesNothing) {
  const FloorSurvey survey(bend(2));
  FeatureStore store(survey, {});
  const auto held = store.of(1);
  store.announce(1);
  store.announce(2);
  store.announce(1'000'000);
  EXPECT_EQ(store.of(1), held);
  EXPECT_EQ(survey.times_taken(1), 1);
}

TEST(FeatureStore, AnAnnouncedFrameNeedNotBeAskedFor) {
  const FloorSurvey survey(bend(2));
  {
    FeatureStore store(survey, {});
    store.announce(0);
    store.announce(1);
  }
  EXPECT_EQ(survey.times_taken(0), 1);
}

TEST(FeatureStore, ABlankPictureHasNone) {
  FloorSurvey survey(bend(1));
  survey.make_blank(0);
  FeatureStore store(survey, {});
  EXPECT_EQ(store.of(0)->size(), 0u);
}

TEST(FeatureStore, AnUnreadablePictureIsBadInputHoweverItWasAskedFor) {
  FloorSurvey survey(bend(3));
  survey.make_unreadable(1);
  FeatureStore store(survey, {});
  EXPECT_THAT(input_error_of([&] { store.of(1); }), HasSubstr("frame-1: is no picture"));
  store.announce(1);
  EXPECT_THAT(input_error_of([&] { store.of(1); }), HasSubstr("frame-1: is no picture"));
  // And again, rather than something else, when asked once more.
  EXPECT_THAT(input_error_of([&] { store.of(1); }), HasSubstr("frame-1: is no picture"));
  EXPECT_GT(store.of(2)->size(), 50u);
}

}  // namespace
}  // namespace fathom
