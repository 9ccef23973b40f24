#include "fathom/front_end/picture_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/front_end/pair_registrar.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "front_end/floor_survey.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::bend;
using test::FloorSurvey;

constexpr std::uint64_t kAnySize = 1'000'000'000;

/// Bytes of one kind, 1186 or as many more.
std::string numbered(int number, std::size_t count = 10) {
  return std::string(16 + 117 * count, static_cast<char>(number));
}

RegistrationKey numbered_key(int number) {
  return {static_cast<std::uint64_t>(number), 7};
}

std::vector<int> kept_of(PictureStore& store, int begin, int end) {
  std::vector<int> kept;
  for (int i = begin; i < end; ++i) {
    if (store.find(numbered_key(i))) kept.push_back(i);
  }
  return kept;
}

TEST(PictureStore, GivesBackWhatAnotherOneWasGiven) {
  const test::TemporaryFolder folder;
  {
    PictureStore store(folder / "made", kAnySize);
    for (int i = 0; i < 5; ++i) store.put(numbered_key(i), numbered(i));
    EXPECT_TRUE(store.find(numbered_key(3)));
  }
  PictureStore store(folder / "made", kAnySize);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(store.find(numbered_key(i)), numbered(i));
  }
  EXPECT_FALSE(store.find(numbered_key(5)));
  EXPECT_FALSE(store.find({3, 8}));
}

TEST(PictureStore, WhatWasNotUsedTheLongestMakesRoom) {
  const test::TemporaryFolder folder;
  for (int round = 0; round < 5; ++round) {
    PictureStore store(folder.path(), kAnySize);
    for (int i = 0; i < 10; ++i) store.put(numbered_key(10 * round + i), numbered(i));
  }
  PictureStore(folder.path(), kAnySize).find(numbered_key(0));
  {
    PictureStore store(folder.path(), 55'000);
    for (int i = 50; i < 60; ++i) store.put(numbered_key(i), numbered(i));
  }
  PictureStore store(folder.path(), kAnySize);
  EXPECT_EQ(kept_of(store, 0, 10), std::vector<int>{0});
  EXPECT_EQ(kept_of(store, 20, 60).size(), 40U);
}

TEST(PictureStore, WithoutRoomFurtherOnesAreNotKept) {
  const test::TemporaryFolder folder;
  PictureStore store(folder.path(), 10'000);
  for (int i = 0; i < 100; ++i) store.put(numbered_key(i), numbered(i));
  EXPECT_EQ(kept_of(store, 0, 100), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_LT(std::filesystem::file_size(folder / kPicturesFile), 60'000U);
}

TEST(PictureStore, SmallOnesMakeRoomForALargeOne) {
  const test::TemporaryFolder folder;
  {
    PictureStore before(folder.path(), 10'000);
    for (int i = 0; i < 8; ++i) before.put(numbered_key(i), numbered(i));
  }
  PictureStore store(folder.path(), 10'000);
  store.put(numbered_key(8), numbered(8, 100));
  EXPECT_EQ(kept_of(store, 0, 9).size(), 8U) << "more than all of it takes none's place";
  store.put(numbered_key(9), numbered(9, 50));
  EXPECT_TRUE(store.find(numbered_key(9)));
  EXPECT_EQ(kept_of(store, 0, 8).size(), 3U);
}

TEST(PictureStore, SeveralUseItAtOnce) {
  const test::TemporaryFolder folder;
  PictureStore first(folder.path(), kAnySize);
  PictureStore second(folder.path(), kAnySize);
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      PictureStore& store = t % 2 == 0 ? first : second;
      for (int i = 0; i < 25; ++i) store.put(numbered_key(100 * t + i), numbered(i));
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (int t = 0; t < 4; ++t) EXPECT_EQ(kept_of(first, 100 * t, 100 * t + 25).size(), 25U) << t;
}

TEST(PictureStore, ADamagedFileIsAMissAndARemovedOneIsMadeAgain) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / kPicturesFile;
  write_file(file, std::string(5000, 'x'));
  {
    PictureStore store(folder.path(), kAnySize);
    store.put(numbered_key(1), numbered(1));
    EXPECT_FALSE(store.find(numbered_key(1)));
  }
  clear_cache(folder.path());
  EXPECT_FALSE(std::filesystem::exists(file));
  PictureStore store(folder.path(), kAnySize);
  store.put(numbered_key(1), numbered(1));
  EXPECT_TRUE(store.find(numbered_key(1)));
  EXPECT_EQ(cache_content(folder.path()).pictures, 1U);
  clear_cache(folder.path());
  EXPECT_EQ(cache_content(folder.path()).pictures, 0U);
  EXPECT_FALSE(store.find(numbered_key(1)));
  PictureStore nowhere("", kAnySize);
  nowhere.put(numbered_key(1), numbered(1));
  EXPECT_FALSE(nowhere.find(numbered_key(1)));
}

TEST(PictureStore, AChangedRowIsAMiss) {
  const test::TemporaryFolder folder;
  for (const char* const change :
       {"UPDATE features SET content = zeroblob(length(content))",
        "UPDATE features SET key = (SELECT zeroblob(16)) WHERE rowid = 1",
        "UPDATE features SET content = 17", "UPDATE features SET checksum = 'x'"}) {
    PictureStore store(folder.path(), kAnySize);
    store.put(numbered_key(1), numbered(1));
    ASSERT_TRUE(store.find(numbered_key(1)));
    SQLite::Database((folder / kPicturesFile).string(), SQLite::OPEN_READWRITE).exec(change);
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
  PictureCache* pictures() override { return &store_; }

 private:
  PictureStore store_;
};

TEST(PictureStore, APairOfKeptFeaturesIsRegisteredWithoutItsPictures) {
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
