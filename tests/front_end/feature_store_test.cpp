#include "fathom/front_end/feature_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/front_end/pair_registrar.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "front_end/floor_survey.hpp"
#include "front_end/same_features.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::bend;
using test::expect_same;
using test::FloorSurvey;

constexpr std::uint64_t kAnySize = 1'000'000'000;

/// Takes some 117 bytes a feature.
PackedFeatures numbered(int number, int count = 10) {
  Features features;
  for (int i = 0; i < count; ++i) {
    features.pixels.emplace_back(number, i);
    features.sizes_px.push_back(0.5F * static_cast<float>(i));
    features.turns_rad.push_back(-0.1F * static_cast<float>(number));
  }
  features.descriptors = cv::Mat(count, 93, CV_8U, cv::Scalar(number % 256));
  return PackedFeatures(features);
}

RegistrationKey numbered_key(int number) {
  return {static_cast<std::uint64_t>(number), 7};
}

std::vector<int> kept_of(FeatureStore& store, int begin, int end) {
  std::vector<int> kept;
  for (int i = begin; i < end; ++i) {
    if (store.find(numbered_key(i))) kept.push_back(i);
  }
  return kept;
}

TEST(FeatureStore, GivesBackWhatAnotherOneWasGiven) {
  const test::TemporaryFolder folder;
  {
    FeatureStore store(folder / "made", kAnySize);
    for (int i = 0; i < 5; ++i) store.put(numbered_key(i), numbered(i));
    EXPECT_TRUE(store.find(numbered_key(3)));
  }
  FeatureStore store(folder / "made", kAnySize);
  for (int i = 0; i < 5; ++i) {
    const auto found = store.find(numbered_key(i));
    ASSERT_TRUE(found);
    expect_same(found->unpacked(), numbered(i).unpacked());
  }
  EXPECT_FALSE(store.find(numbered_key(5)));
  EXPECT_FALSE(store.find({3, 8}));
}

TEST(FeatureStore, WhatWasNotUsedTheLongestMakesRoom) {
  const test::TemporaryFolder folder;
  for (int round = 0; round < 5; ++round) {
    FeatureStore store(folder.path(), kAnySize);
    for (int i = 0; i < 10; ++i) store.put(numbered_key(10 * round + i), numbered(i));
  }
  FeatureStore(folder.path(), kAnySize).find(numbered_key(0));
  {
    FeatureStore store(folder.path(), 55'000);
    for (int i = 50; i < 60; ++i) store.put(numbered_key(i), numbered(i));
  }
  FeatureStore store(folder.path(), kAnySize);
  EXPECT_EQ(kept_of(store, 0, 10), std::vector<int>{0});
  EXPECT_EQ(kept_of(store, 20, 60).size(), 40U);
}

TEST(FeatureStore, WithoutRoomFurtherOnesAreNotKept) {
  const test::TemporaryFolder folder;
  FeatureStore store(folder.path(), 10'000);
  for (int i = 0; i < 100; ++i) store.put(numbered_key(i), numbered(i));
  EXPECT_EQ(kept_of(store, 0, 100), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_LT(std::filesystem::file_size(folder / kFeaturesFile), 60'000U);
}

TEST(FeatureStore, SmallOnesMakeRoomForALargeOne) {
  const test::TemporaryFolder folder;
  {
    FeatureStore before(folder.path(), 10'000);
    for (int i = 0; i < 8; ++i) before.put(numbered_key(i), numbered(i));
  }
  FeatureStore store(folder.path(), 10'000);
  store.put(numbered_key(8), numbered(8, 100));
  EXPECT_EQ(kept_of(store, 0, 9).size(), 8U) << "more than all of it takes none's place";
  store.put(numbered_key(9), numbered(9, 50));
  EXPECT_TRUE(store.find(numbered_key(9)));
  EXPECT_EQ(kept_of(store, 0, 8).size(), 3U);
}

TEST(FeatureStore, SeveralUseItAtOnce) {
  const test::TemporaryFolder folder;
  FeatureStore first(folder.path(), kAnySize);
  FeatureStore second(folder.path(), kAnySize);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      FeatureStore& store = t % 2 == 0 ? first : second;
      for (int i = 0; i < 25; ++i) store.put(numbered_key(100 * t + i), numbered(i));
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int t = 0; t < 4; ++t) EXPECT_EQ(kept_of(first, 100 * t, 100 * t + 25).size(), 25U) << t;
}

TEST(FeatureStore, ADamagedFileIsAMissAndARemovedOneIsMadeAgain) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / kFeaturesFile;
  write_file(file, std::string(5000, 'x'));
  {
    FeatureStore store(folder.path(), kAnySize);
    store.put(numbered_key(1), numbered(1));
    EXPECT_FALSE(store.find(numbered_key(1)));
  }
  clear_cache(folder.path());
  EXPECT_FALSE(std::filesystem::exists(file));
  FeatureStore store(folder.path(), kAnySize);
  store.put(numbered_key(1), numbered(1));
  EXPECT_TRUE(store.find(numbered_key(1)));
  EXPECT_EQ(cache_content(folder.path()).pictures, 1U);
  clear_cache(folder.path());
  EXPECT_EQ(cache_content(folder.path()).pictures, 0U);
  EXPECT_FALSE(store.find(numbered_key(1)));
  FeatureStore nowhere("", kAnySize);
  nowhere.put(numbered_key(1), numbered(1));
  EXPECT_FALSE(nowhere.find(numbered_key(1)));
}

TEST(FeatureStore, AChangedRowIsAMiss) {
  const test::TemporaryFolder folder;
  for (const char* const change :
       {"UPDATE features SET content = zeroblob(length(content))",
        "UPDATE features SET key = (SELECT zeroblob(16)) WHERE rowid = 1",
        "UPDATE features SET content = 17", "UPDATE features SET checksum = 'x'"}) {
    FeatureStore store(folder.path(), kAnySize);
    store.put(numbered_key(1), numbered(1));
    ASSERT_TRUE(store.find(numbered_key(1)));
    SQLite::Database((folder / kFeaturesFile).string(), SQLite::OPEN_READWRITE).exec(change);
    EXPECT_FALSE(store.find(numbered_key(1))) << change;
    EXPECT_FALSE(store.find({0, 0})) << change;
    clear_cache(folder.path());
  }
}

TEST(FeatureKeys, KnowPictureOptionsTuningAndMask) {
  const FeatureOptions options;
  const FeatureTuning tuning;
  const RegistrationKey usual = FeatureKeys(options, tuning, {}).of(5);
  EXPECT_EQ(FeatureKeys(options, tuning, {}).of(5), usual);
  EXPECT_NE(usual.first, usual.second);
  FeatureOptions fewer;
  fewer.max_features = 1999;
  FeatureTuning other;
  other.noise_left += 1e-9;
  for (const RegistrationKey& one :
       {FeatureKeys(options, tuning, {}).of(6), FeatureKeys(fewer, tuning, {}).of(5),
        FeatureKeys(options, other, {}).of(5),
        FeatureKeys(options, tuning, cv::Mat(4, 4, CV_8U, cv::Scalar(255))).of(5)}) {
    EXPECT_NE(one.first, usual.first);
    EXPECT_NE(one.second, usual.second);
  }
}

/// A cache that has features alone.
class FeaturesAlone : public RegistrationCache {
 public:
  explicit FeaturesAlone(const std::filesystem::path& folder) : store_(folder, kAnySize) {}
  std::optional<PairRegistration> find(const RegistrationKey&) override { return std::nullopt; }
  void put(const RegistrationKey&, const PairRegistration&) override {}
  FeatureCache* features() override { return &store_; }

 private:
  FeatureStore store_;
};

TEST(FeatureStore, APairOfKeptFeaturesIsRegisteredWithoutItsPictures) {
  const test::TemporaryFolder folder;
  const auto registered = [&](const FloorSurvey& survey) {
    FeaturesAlone cache(folder.path());
    PairRegistrar registrar(survey, {}, {}, 3, &cache);
    return registrar.of(MeasuredFrame::of(survey, 0), MeasuredFrame::of(survey, 1));
  };
  const FloorSurvey first(bend(2));
  const PairRegistration made = registered(first);
  EXPECT_TRUE(made.found);
  EXPECT_EQ(first.times_taken(0), 1);
  const FloorSurvey second(bend(2));
  EXPECT_EQ(registered(second), made);
  EXPECT_EQ(second.times_taken(0), 0);
  EXPECT_EQ(second.times_taken(1), 0);
}

}  // namespace
}  // namespace fathom
