#include "fathom/front_end/registration_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/configured.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/small_config.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kFile = "registrations.sqlite";

PairRegistration random_registration(RandomStream& random) {
  return {random.uniform() < 0.8, test::random_pose(random), test::random_covariance(random, 1e-4),
          static_cast<int>(random.index(500))};
}

RegistrationKey key(std::uint64_t i) {
  return {mix_bits(i), mix_bits(~i)};
}

bool same_bits(const PairRegistration& a, const PairRegistration& b) {
  return a.found == b.found && a.inliers == b.inliers &&
         std::memcmp(&a.motion, &b.motion, sizeof a.motion) == 0 &&
         std::memcmp(a.covariance.data(), b.covariance.data(), 9 * sizeof(double)) == 0;
}

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

void expect_works_in_memory(const fs::path& folder, const std::string& problem) {
  RegistrationStore store(folder);
  EXPECT_THAT(store.problem(), HasSubstr(problem));
  RandomStream random(5);
  const PairRegistration value = random_registration(random);
  EXPECT_FALSE(store.find(key(1)));
  for (std::uint64_t i = 0; i < 500; ++i) store.put(key(i), value);
  store.flush();
  for (std::uint64_t i = 0; i < 500; ++i) EXPECT_TRUE(same_bits(*store.find(key(i)), value));
}

TEST(RegistrationStore, ADamagedFileLeavesMemory) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / kFile) << std::string(10'000, 'x');
  expect_works_in_memory(folder.path(), "registrations.sqlite: file is not a database");
}

TEST(RegistrationStore, AFolderThatCannotBeLeavesMemory) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "file") << "x";
  expect_works_in_memory(folder / "file", "unable to open");
  fs::create_directories(folder / "b" / kFile);
  expect_works_in_memory(folder / "b", "unable to open");
  expect_works_in_memory("", "no folder");
}

TEST(RegistrationStore, AReadOnlyFolderLeavesMemory) {
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere";
  const test::TemporaryFolder folder;
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  expect_works_in_memory(folder.path(), "unable to open");
  fs::permissions(folder.path(), fs::perms::owner_all);
}

// A store of one value and the bytes of its file, all in the file itself.
std::string file_of_one(const fs::path& folder, const PairRegistration& value) {
  {
    RegistrationStore store(folder);
    store.put(key(1), value);
  }
  std::ifstream file(folder / kFile, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

TEST(RegistrationStore, AFlippedBitIsAMissAndNoResult) {
  const test::TemporaryFolder folder;
  PairRegistration value;
  value.found = true;
  value.motion = {1.25, 2.5, 0.125};
  std::string bytes = file_of_one(folder.path(), value);
  const std::string motion(reinterpret_cast<const char*>(&value.motion), sizeof value.motion);
  const std::size_t place = bytes.find(motion);
  ASSERT_NE(place, std::string::npos);
  bytes[place + 3] = static_cast<char>(bytes[place + 3] ^ 4);
  std::ofstream(folder / kFile, std::ios::binary | std::ios::trunc) << bytes;
  RegistrationStore store(folder.path());
  EXPECT_FALSE(store.find(key(1)));
  store.put(key(1), value);
  store.flush();
  EXPECT_TRUE(RegistrationStore(folder.path()).find(key(1)));
}

// Whether SQLite sees the damage when it opens the file, when it reads or never: no result of it.
TEST(RegistrationStore, AFileCutShortThrowsNothing) {
  RandomStream random(6);
  const PairRegistration value = random_registration(random);
  const test::TemporaryFolder whole;
  const std::string bytes = file_of_one(whole.path(), value);
  ASSERT_GT(bytes.size(), 4096u);
  for (const std::size_t size : {100u, 1000u, 4096u, 4500u}) {
    const test::TemporaryFolder folder;
    std::ofstream(folder / kFile, std::ios::binary) << bytes.substr(0, size);
    RegistrationStore store(folder.path());
    EXPECT_FALSE(store.find(key(1))) << size;
    store.put(key(2), value);
    store.flush();
    const auto found = store.find(key(2));
    ASSERT_TRUE(found) << size;
    EXPECT_TRUE(same_bits(*found, value)) << size;
  }
}

TEST(RegistrationStore, AnotherVersionIsEmptied) {
  const test::TemporaryFolder folder;
  file_of_one(folder.path(), {});
  {
    SQLite::Database sqlite((folder / kFile).string(), SQLite::OPEN_READWRITE);
    sqlite.exec("PRAGMA user_version = 77");
    sqlite.exec("CREATE TABLE \"an \"\"odd\"\" name\" (a)");
    sqlite.exec("CREATE VIEW looks AS SELECT * FROM registration");
  }
  RegistrationStore store(folder.path());
  EXPECT_FALSE(store.find(key(1)));
  store.put(key(1), {});
  store.flush();
  EXPECT_THAT(store.problem(), IsEmpty());
  SQLite::Database sqlite((folder / kFile).string());
  EXPECT_EQ(sqlite.execAndGet("SELECT count(*) FROM sqlite_master WHERE type <> 'index'").getInt(),
            1);
  EXPECT_EQ(sqlite.execAndGet("SELECT count(*) FROM registration").getInt(), 1);
}

class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* before = std::getenv(name)) before_ = before;
    if (value != nullptr) {
      ::setenv(name, value, 1);
    } else {
      ::unsetenv(name);
    }
  }
  ~Environment() {
    if (before_) {
      ::setenv(name_, before_->c_str(), 1);
    } else {
      ::unsetenv(name_);
    }
  }

 private:
  const char* name_;
  std::optional<std::string> before_;
};

TEST(RegistrationStore, TheFolderIsThatOfTheEnvironment) {
  const Environment home("HOME", "/h");
  const Environment own("FATHOM_CACHE", "/own");
  const Environment xdg("XDG_CACHE_HOME", "/xdg");
  EXPECT_EQ(default_cache_folder(), "/own");
  const Environment no_own("FATHOM_CACHE", "");
  EXPECT_EQ(default_cache_folder(), "/xdg/fathom");
  const Environment no_xdg("XDG_CACHE_HOME", nullptr);
  EXPECT_EQ(default_cache_folder(), "/h/.cache/fathom");
  const Environment no_home("HOME", nullptr);
  EXPECT_EQ(default_cache_folder(), "");
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
