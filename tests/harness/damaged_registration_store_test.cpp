// A store of registrations whose file or folder is not what it should be: it goes on in memory, and
// gives no wrong result.

#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "harness/registration_values.hpp"
#include "support/requirements.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using test::key;
using test::random_registration;
using test::same_bits;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr const char* kFile = "registrations.sqlite";

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
  FATHOM_REQUIRE_NO_ROOT();
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

}  // namespace
}  // namespace fathom
