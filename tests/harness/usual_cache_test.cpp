#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdlib>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "harness/registration_values.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::key;
using test::same_bits;
using ::testing::IsEmpty;

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

TEST(UsualCache, TheFolderIsThatOfTheEnvironment) {
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

TEST(UsualCache, TheSizeIsThatOfTheEnvironment) {
  const Environment none("FATHOM_CACHE_MB", nullptr);
  EXPECT_EQ(default_cache_bytes(), 1'000'000'000U);
  const Environment own("FATHOM_CACHE_MB", "2.5");
  EXPECT_EQ(default_cache_bytes(), 2'500'000U);
  for (const char* const bad : {"x", "0", "-3", "nan", "1e12", "5 MB"}) {
    const Environment wrong("FATHOM_CACHE_MB", bad);
    EXPECT_THROW(default_cache_bytes(), InputError) << bad;
  }
}

std::size_t kept_of(RegistrationStore& store, std::uint64_t begin, std::uint64_t end) {
  std::size_t kept = 0;
  for (std::uint64_t i = begin; i < end; ++i) kept += store.find(key(i)) ? 1 : 0;
  return kept;
}

TEST(UsualCache, WhatWasNotUsedTheLongestGoesFirst) {
  const test::TemporaryFolder folder;
  constexpr std::uint64_t kMostBytes = 1'000'000;
  const auto fill = [&](std::uint64_t begin, std::uint64_t end, std::uint64_t most_bytes) {
    RegistrationStore store(folder.path(), most_bytes);
    for (std::uint64_t i = begin; i < end; ++i) store.put(key(i), {});
  };
  fill(0, 400, 0);
  fill(400, 800, 0);
  {
    RegistrationStore store(folder.path());
    EXPECT_EQ(kept_of(store, 0, 100), 100U);  // are used now
  }
  const std::uint64_t whole = cache_content(folder.path()).bytes;
  ASSERT_GT(whole, 600'000U);
  fill(800, 1400, kMostBytes);
  const CacheContent content = cache_content(folder.path());
  EXPECT_LT(content.registrations, 1400U);
  EXPECT_GT(content.registrations, 700U);
  RegistrationStore store(folder.path());
  EXPECT_EQ(kept_of(store, 0, 100), 100U);
  EXPECT_LT(kept_of(store, 100, 400), 300U);
  EXPECT_EQ(kept_of(store, 800, 1400), 600U);
  EXPECT_THAT(store.problem(), IsEmpty());
}

TEST(UsualCache, OfOneProcessNoneIsRemoved) {
  const test::TemporaryFolder folder;
  {
    RegistrationStore store(folder.path(), 1000);
    for (std::uint64_t i = 0; i < 500; ++i) store.put(key(i), {});
  }
  EXPECT_EQ(cache_content(folder.path()).registrations, 500U);
  RegistrationStore(folder.path(), 1000).find(key(7));
  EXPECT_EQ(cache_content(folder.path()).registrations, 1U);
}

TEST(UsualCache, AFileThatIsTooLargeIsUsedAgainAndDoesNotGrow) {
  const test::TemporaryFolder folder;
  constexpr std::uint64_t kMostBytes = 500'000;
  for (std::uint64_t round = 0; round < 8; ++round) {
    RegistrationStore store(folder.path(), kMostBytes);
    for (std::uint64_t i = 0; i < 300; ++i) store.put(key(1000 * round + i), {});
  }
  EXPECT_LT(cache_content(folder.path()).bytes, 2 * kMostBytes);
}

TEST(UsualCache, OneOfTheVersionBeforeIsGoneOnWith) {
  const test::TemporaryFolder folder;
  const PairRegistration value{true, {1.0, 2.0, 3.0}, Eigen::Matrix3d::Identity(), 17};
  {
    RegistrationStore store(folder.path());
    store.put(key(1), value);
    store.finish();
  }
  {
    SQLite::Database sqlite((folder / kRegistrationsFile).string(), SQLite::OPEN_READWRITE);
    sqlite.exec("DROP INDEX registration_used");
    sqlite.exec("ALTER TABLE registration DROP COLUMN used");
    sqlite.exec("PRAGMA user_version = 1");
  }
  const auto found = RegistrationStore::read_only(folder.path())->find(key(1));
  ASSERT_TRUE(found);
  EXPECT_TRUE(same_bits(*found, value));
  RegistrationStore again(folder.path());
  ASSERT_TRUE(again.find(key(1)));
  again.put(key(2), value);
  again.flush();
  EXPECT_EQ(cache_content(folder.path()).registrations, 2U);
  EXPECT_THAT(again.problem(), IsEmpty());
}

TEST(UsualCache, IsClearedWhileAnotherUsesIt) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(cache_content(folder.path()).bytes, 0U);
  clear_cache(folder.path());
  RegistrationStore store(folder.path());
  for (std::uint64_t i = 0; i < 2000; ++i) store.put(key(i), {});
  store.flush();
  const std::uint64_t bytes = cache_content(folder.path()).bytes;
  clear_cache(folder.path());
  EXPECT_EQ(cache_content(folder.path()).registrations, 0U);
  EXPECT_LT(cache_content(folder.path()).bytes, bytes / 10);
  EXPECT_FALSE(store.find(key(3)));
  store.put(key(3), {});
  store.flush();
  EXPECT_TRUE(store.find(key(3)));
  EXPECT_THAT(store.problem(), IsEmpty());
}

TEST(UsualCache, ADamagedOneIsSaidAndCleared) {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder / kRegistrationsFile;
  write_file(file, std::string(5000, 'x'));
  EXPECT_THROW(cache_content(folder.path()), InputError);
  clear_cache(folder.path());
  EXPECT_FALSE(std::filesystem::exists(file));
}

}  // namespace
}  // namespace fathom
