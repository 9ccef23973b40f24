#include "fathom/front_end/feature_memory.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "front_end/floor_survey.hpp"
#include "front_end/same_features.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::bend;
using test::expect_same;
using test::FloorSurvey;
using test::input_error_of;
using ::testing::HasSubstr;

constexpr std::size_t kPlenty = std::size_t{1} << 30;

TEST(PackedFeatures, SiftFitsInBytesWithoutLoss) {
  const FloorSurvey survey(bend(1));
  const Features features = FeatureExtractor().extract(survey.image(0));
  ASSERT_GT(features.size(), 50u);
  ASSERT_EQ(features.descriptors.type(), CV_32F);
  ASSERT_EQ(features.sizes_px.size(), features.size());
  ASSERT_EQ(features.turns_rad.size(), features.size());
  const PackedFeatures packed(features);
  expect_same(packed.unpacked(), features);
  // Two doubles of the pixel, two floats of size and turn, 128 bytes of the descriptor.
  EXPECT_NEAR(static_cast<double>(packed.bytes()), 152.0 * static_cast<double>(features.size()),
              200.0);
}

TEST(PackedFeatures, BinaryDescriptorsStayWhatTheyAre) {
  const FloorSurvey survey(bend(1));
  FeatureOptions options;
  options.type = "orb";
  const Features features = FeatureExtractor(options).extract(survey.image(0));
  ASSERT_GT(features.size(), 50u);
  expect_same(PackedFeatures(features).unpacked(), features);
}

TEST(PackedFeatures, WhatNoByteHoldsIsKeptAsItIs) {
  for (const float value : {0.5F, -1.0F, 256.0F}) {
    const Features features{
        {{1.0, 2.0}}, {3.5F}, {-0.7F}, cv::Mat(1, 4, CV_32F, cv::Scalar(value))};
    expect_same(PackedFeatures(features).unpacked(), features);
  }
}

TEST(PackedFeatures, AsBytesAndBackAreTheSame) {
  const FloorSurvey survey(bend(1));
  for (const char* const type : {"sift", "orb"}) {
    FeatureOptions options;
    options.type = type;
    const PackedFeatures packed(FeatureExtractor(options).extract(survey.image(0)));
    const std::string bytes = packed.to_bytes();
    const auto again = PackedFeatures::from_bytes(bytes);
    ASSERT_TRUE(again);
    expect_same(again->unpacked(), packed.unpacked());
    EXPECT_FALSE(PackedFeatures::from_bytes(bytes.substr(0, bytes.size() - 1)));
    EXPECT_FALSE(PackedFeatures::from_bytes(bytes + '0'));
    EXPECT_FALSE(PackedFeatures::from_bytes(bytes.substr(0, 5)));
    for (std::size_t i = 0; i < 16; ++i) {
      std::string wrong = bytes;
      wrong[i] = static_cast<char>(wrong[i] ^ 0x5a);
      EXPECT_FALSE(PackedFeatures::from_bytes(wrong)) << "byte " << i << " of the head";
    }
  }
  const auto none = PackedFeatures::from_bytes(PackedFeatures(Features{}).to_bytes());
  ASSERT_TRUE(none);
  EXPECT_EQ(none->size(), 0u);
}

TEST(PackedFeatures, OfABlankPictureAreNone) {
  const PackedFeatures packed{Features{}};
  EXPECT_EQ(packed.size(), 0u);
  EXPECT_TRUE(packed.unpacked().descriptors.empty());
}

TEST(FeatureMemory, GivesTheFeaturesOfTheFrameWithItsOptions) {
  const FloorSurvey survey(bend(3));
  FeatureMemory memory({survey, FeatureExtractor()}, kPlenty);
  expect_same(memory.of(2)->unpacked(), FeatureExtractor().extract(survey.image(2)));
  FeatureOptions options;
  options.max_features = 40;
  EXPECT_EQ(FeatureMemory({survey, FeatureExtractor(options)}, kPlenty).of(0)->size(), 40u);
}

TEST(FeatureMemory, ExtractsOnceWhatFits) {
  const FloorSurvey survey(bend(8));
  FeatureMemory memory({survey, FeatureExtractor()}, kPlenty);
  for (int pass = 0; pass < 2; ++pass) {
    for (std::size_t i = 0; i < 8; ++i) memory.of(i);
  }
  for (std::size_t i = 0; i < 8; ++i) EXPECT_EQ(survey.times_taken(i), 1) << i;
}

TEST(FeatureMemory, LetsGoOfThoseUsedLongestAgo) {
  const FloorSurvey survey(bend(4));
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    bytes += PackedFeatures(FeatureExtractor().extract(survey.image(i))).bytes();
  }
  const FloorSurvey counted(bend(4));
  FeatureMemory memory({counted, FeatureExtractor()}, bytes);
  for (const std::size_t frame : {0u, 1u, 2u, 0u}) memory.of(frame);
  memory.of(3);  // of 0, 1, 2 the one used longest ago is 1
  memory.of(0);
  EXPECT_EQ(counted.times_taken(0), 1);
  memory.of(1);
  EXPECT_EQ(counted.times_taken(1), 2);
}

TEST(FeatureMemory, WithoutRoomHoldsOne) {
  const FloorSurvey survey(bend(2));
  FeatureMemory memory({survey, FeatureExtractor()}, 0);
  for (const std::size_t frame : {0u, 0u, 1u, 0u}) EXPECT_GT(memory.of(frame)->size(), 50u);
  EXPECT_EQ(survey.times_taken(0), 2);
  EXPECT_EQ(survey.times_taken(1), 1);
}

TEST(FeatureMemory, AnAnnouncedFrameIsTheSame) {
  const FloorSurvey survey(bend(3));
  FeatureMemory memory({survey, FeatureExtractor()}, kPlenty);
  memory.announce(2);
  memory.announce(2);
  memory.announce(1);
  const auto second = memory.of(2);
  const auto first = memory.of(1);
  memory.announce(1);
  EXPECT_EQ(survey.times_taken(1), 1);
  EXPECT_EQ(survey.times_taken(2), 1);
  expect_same(second->unpacked(), FeatureExtractor().extract(survey.image(2)));
  expect_same(first->unpacked(), FeatureExtractor().extract(survey.image(1)));
}

TEST(FeatureMemory, AnAnnouncedFrameNeedNotBeAskedFor) {
  const FloorSurvey survey(bend(2));
  {
    FeatureMemory memory({survey, FeatureExtractor()}, kPlenty);
    memory.announce(0);
    memory.announce(1);
  }
  EXPECT_EQ(survey.times_taken(0), 1);
}

TEST(FeatureMemory, AnUnreadablePictureIsBadInputHoweverItWasAskedFor) {
  FloorSurvey survey(bend(3));
  survey.make_unreadable(1);
  FeatureMemory memory({survey, FeatureExtractor()}, kPlenty);
  const auto message = [&] { return input_error_of([&] { memory.of(1); }); };
  EXPECT_THAT(message(), HasSubstr("frame-1: is no picture"));
  memory.announce(1);
  EXPECT_THAT(message(), HasSubstr("frame-1: is no picture"));
  // And again, rather than something else, when asked once more.
  EXPECT_THAT(message(), HasSubstr("frame-1: is no picture"));
  EXPECT_GT(memory.of(2)->size(), 50u);
}

}  // namespace
}  // namespace fathom
