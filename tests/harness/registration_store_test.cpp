#include "fathom/front_end/registration_store.hpp"

#include <filesystem>
#include <limits>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/registration_values.hpp"
#include "harness/small_config.hpp"
#include "support/killed_process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::key;
using test::random_registration;
using test::same_bits;
using ::testing::IsEmpty;

TEST(RegistrationStore, GivesBackBitForBit) {
  const test::TemporaryFolder folder;
  RandomStream random(3);
  std::vector<PairRegistration> values;
  for (int i = 0; i < 450; ++i) values.push_back(random_registration(random));
  values[7].motion = {-0.0, 5e-324, std::numeric_limits<double>::quiet_NaN()};
  {
    RegistrationStore store(folder / "a" / "b");
    for (std::size_t i = 0; i < values.size(); ++i) store.put(key(i), values[i]);
    EXPECT_TRUE(same_bits(*store.find(key(449)), values[449]));  // not yet written
    EXPECT_THAT(store.problem(), IsEmpty());
  }
  RegistrationStore again(folder / "a" / "b");
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto found = again.find(key(i));
    ASSERT_TRUE(found) << i;
    EXPECT_TRUE(same_bits(*found, values[i])) << i;
  }
  EXPECT_FALSE(again.find(key(450)));
  EXPECT_FALSE(again.find({key(0).first, key(1).second}));
  EXPECT_FALSE(again.find({key(1).first, key(0).second}));
}

TEST(RegistrationStore, TwoOnOneFileSeeWhatTheOtherWrote) {
  const test::TemporaryFolder folder;
  RegistrationStore a(folder.path());
  RegistrationStore b(folder.path());
  RandomStream random(4);
  const PairRegistration value = random_registration(random);
  a.put(key(1), value);
  a.flush();
  ASSERT_TRUE(b.find(key(1)));
  EXPECT_TRUE(same_bits(*b.find(key(1)), value));
  b.put(key(1), value);
  b.put(key(2), value);
  b.flush();
  EXPECT_TRUE(a.find(key(2)));
  EXPECT_THAT(a.problem() + b.problem(), IsEmpty());
}

// SQLite's log of a process that was killed in the folder is no part of the cache that takes its
// place.
TEST(RegistrationStore, AMergeIntoTheCacheOfAKilledProcessHasAll) {
  const test::TemporaryFolder folder;
  const auto put = [](RegistrationStore& store, std::uint64_t from, std::uint64_t to) {
    for (std::uint64_t i = from; i < to; ++i) {
      PairRegistration value;
      value.inliers = static_cast<int>(i);
      store.put(key(i), value);
    }
    store.flush();
  };
  test::in_killed_process([&] { put(*new RegistrationStore(folder / "all"), 0, 300); });
  ASSERT_TRUE(std::filesystem::exists(folder / "all" / "registrations.sqlite-wal"));
  {
    RegistrationStore store(folder / "one");
    put(store, 200, 800);
  }
  EXPECT_EQ(merge_registrations({folder / "one"}, folder / "all").count, 800u);
  EXPECT_FALSE(std::filesystem::exists(folder / "all" / "registrations.sqlite-wal"));
  EXPECT_EQ(RegistrationStore::read_only(folder / "all")->all().size(), 800u);
  EXPECT_EQ(RegistrationStore::read_only("/" + (folder / "all").string())->all().size(), 800u);
  EXPECT_EQ(cache_content(folder / "all").registrations, 800u);
  // One that is in use is left as it is.
  RegistrationStore in_use(folder / "all");
  EXPECT_THROW(merge_registrations({folder / "one"}, folder / "all"), InputError);
  put(in_use, 800, 900);
  EXPECT_EQ(cache_content(folder / "all").registrations, 900u);
}

TEST(RegistrationStore, ManyThreadsAndStoresWriteAtOnce) {
  const test::TemporaryFolder folder;
  constexpr std::size_t kThreads = 4;
  constexpr std::uint64_t kEach = 500;
  {
    RegistrationStore a(folder.path());
    RegistrationStore b(folder.path());
    std::vector<std::thread> threads;
    for (std::size_t t = 0; t < kThreads; ++t) {
      threads.emplace_back([&, t] {
        RegistrationStore& store = t % 2 == 0 ? a : b;
        for (std::uint64_t i = 0; i < kEach; ++i) {
          PairRegistration value;
          value.inliers = static_cast<int>(t * kEach + i);
          store.put(key(t * kEach + i), value);
        }
      });
    }
    for (std::thread& thread : threads) thread.join();
    EXPECT_THAT(a.problem() + b.problem(), IsEmpty());
  }
  RegistrationStore all(folder.path());
  for (std::uint64_t i = 0; i < kThreads * kEach; ++i) {
    const auto found = all.find(key(i));
    ASSERT_TRUE(found) << i;
    EXPECT_EQ(found->inliers, static_cast<int>(i));
  }
}

void expect_same_recording(const std::string& more) {
  const Configuration configuration = test::configured(test::kSmallSurvey + more);
  const auto log = [&](RegistrationCache* cache) {
    return to_g2o(record(configuration, builtin_estimators(), {}, cache).log);
  };
  const test::TemporaryFolder folder;
  const std::string plain = log(nullptr);
  {
    RegistrationStore store(folder.path());
    EXPECT_EQ(log(&store), plain);
  }
  RegistrationStore store(folder.path());
  EXPECT_EQ(log(&store), plain);
}

TEST(RegistrationStore, ARecordingIsTheSameWithAndWithout) {
  expect_same_recording("");
}

TEST(RegistrationStore, ARecordingWithVisualOdometryIsTheSameWithAndWithout) {
  expect_same_recording(test::kVisualOdometry);
}

}  // namespace
}  // namespace fathom
