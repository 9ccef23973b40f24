// A store that is written on a disk of this machine and published elsewhere.

#include "fathom/results/scratch_store.hpp"

#include <SQLiteCpp/SQLiteCpp.h>
#include <cstdlib>
#include <memory>
#include <thread>
#include <unistd.h>

#include <gmock/gmock.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/results/merge.hpp"
#include "fathom/results/store_folder.hpp"
#include "results/stored_runs.hpp"
#include "support/killed_process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using std::chrono_literals::operator""ms;
using test::description;
using test::in_killed_process;
using test::record;
using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr ClaimTimes kQuick{20ms, 400ms};

class Scratch : public ::testing::Test {
 protected:
  fs::path out() const { return folder_.path() / "shared" / "shard-1"; }
  fs::path disk() const { return folder_.path() / "disk"; }
  std::unique_ptr<ScratchStore> open(const StudyDescription& study = description()) const {
    return std::make_unique<ScratchStore>(out(), disk(), study, "{}", kQuick);
  }
  std::size_t published() const { return ResultStore::open(out()).runs().size(); }

 private:
  TemporaryFolder folder_;
};

TEST_F(Scratch, PublishesWholeStoresAndLeavesTheDiskEmpty) {
  {
    const auto scratch = open();
    scratch->store().add(record(0, 0, "plain"));
    EXPECT_FALSE(fs::exists(out() / "results.sqlite"));
    scratch->publish_when_due();  // it is not
    EXPECT_FALSE(fs::exists(out() / "results.sqlite"));
    scratch->publish();
    EXPECT_EQ(published(), 1u);
    scratch->store().add(record(0, 1, "plain"));
    EXPECT_EQ(published(), 1u);
  }
  EXPECT_EQ(published(), 2u);
  EXPECT_TRUE(fs::is_empty(disk()));
  std::set<std::string> left;
  for (const auto& entry : fs::directory_iterator(out())) left.insert(entry.path().filename());
  EXPECT_EQ(left, std::set<std::string>{"results.sqlite"});
}

TEST_F(Scratch, GoesOnFromWhatWasPublishedOnAnotherMachine) {
  { open()->store().add(record(0, 0, "plain")); }
  fs::remove_all(disk());
  const auto scratch = open();
  EXPECT_EQ(scratch->store().runs().size(), 1u);
  EXPECT_EQ(scratch->store().manifests().size(), 2u);
}

// Killed before it could publish: on the same machine nothing of it is lost.
TEST_F(Scratch, GoesOnFromWhatAKilledProcessLeftOnTheDisk) {
  { open()->store().add(record(0, 0, "plain")); }
  in_killed_process([&] {
    auto scratch = open();
    scratch->store().add(record(0, 1, "plain"));
    scratch->store().add(record(1, 0, "plain"));
    static_cast<void>(scratch.release());
  });
  EXPECT_EQ(published(), 1u);
  { const auto scratch = open(); }
  EXPECT_EQ(published(), 3u);
}

// Killed as it left WAL: SQLite has a change to take back, which a reader may not.
TEST_F(Scratch, GoesOnFromAStoreThatWasBeingFinished) {
  in_killed_process([&] {
    auto scratch = open();
    scratch->store().add(record(0, 0, "plain"));
    scratch->store().finish();
    SQLite::Database sqlite(scratch->store().file().string(), SQLite::OPEN_READWRITE);
    sqlite.exec("PRAGMA synchronous = OFF; BEGIN; UPDATE study SET value = 'x'");
    ::_exit(0);
  });
  std::size_t journals = 0;
  for (const auto& entry : fs::recursive_directory_iterator(disk())) {
    journals += entry.path().filename() == "results.sqlite-journal" ? 1 : 0;
  }
  ASSERT_EQ(journals, 1u);
  { const auto scratch = open(); }
  EXPECT_EQ(published(), 1u);
}

// A run that was not divided, killed in the same folder: what stands in its log is gone on from,
// and is applied to no store that is published in its place.
TEST_F(Scratch, GoesOnFromWhatAKilledUndividedRunLeftInTheFolder) {
  in_killed_process([&] {
    auto* store = new ResultStore(ResultStore::write(out(), description(), "{}"));
    for (std::size_t cell = 0; cell < 6; ++cell) store->add(record(cell, 0, "plain"));
  });
  ASSERT_TRUE(fs::exists(out() / "results.sqlite-wal"));
  {
    const auto scratch = open();
    EXPECT_EQ(scratch->store().runs().size(), 6u);
    scratch->store().add(record(0, 1, "plain"));
  }
  EXPECT_FALSE(fs::exists(out() / "results.sqlite-wal"));
  EXPECT_EQ(published(), 7u);
}

TEST_F(Scratch, IsRefusedWhereAnUndividedRunIsAtWork) {
  ResultStore store = ResultStore::write(out(), description(), "{}");
  store.add(record(0, 0, "plain"));
  EXPECT_THROW(open(), InputError);
  store.add(record(0, 1, "plain"));
  EXPECT_EQ(published(), 2u);
}

TEST_F(Scratch, OfAnotherStudyOnTheDiskIsNotTaken) {
  { open()->store().add(record(0, 0, "plain")); }
  fs::remove_all(out());
  StudyDescription other = description();
  other.configuration.back().second = "2";
  EXPECT_EQ(open(other)->store().runs().size(), 0u);
  fs::remove_all(disk());
  try {
    open();
    FAIL() << "goes on with another study";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr((out() / "results.sqlite").string()));
    EXPECT_THAT(error.what(), HasSubstr("seed: 2 there, 1 here"));
  }
}

TEST_F(Scratch, TwoOnOneFolderAreRefused) {
  const auto one = open();
  EXPECT_THROW(open(), InputError);
}

TEST_F(Scratch, KeepsOutWhoeverWouldWriteThereInAnotherWay) {
  { open()->store().add(record(0, 0, "plain")); }
  const auto shard = open();
  const auto expect_refusal = [](const auto& action) {
    try {
      action();
      FAIL() << "not refused";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("process " + std::to_string(::getpid()) + " on "));
    }
  };
  expect_refusal([&] { merge_stores({out()}, out()); });
  expect_refusal([&] { const StoreFolder undivided(out(), description(), "{}"); });
}

// One that came in spite of the claim.
TEST_F(Scratch, LeavesNoPartWhereAnUndividedRunIsInItsWay) {
  auto scratch = open();
  const ResultStore undivided = ResultStore::write(out(), description(), "{}");
  EXPECT_THROW(scratch->publish(), InputError);
  EXPECT_FALSE(fs::exists(out() / "results.sqlite.part"));
}

TEST_F(Scratch, WritesNothingMoreWhereAnotherMachineTookOver) {
  auto scratch = open();
  scratch->store().add(record(0, 0, "plain"));
  // Again until it stays: the claim may be renewed just then.
  const std::string other = "elsewhere 1 another-boot 0 0\n";
  do {
    write_file(out() / "other", other);
    fs::rename(out() / "other", out() / "results.owner");
    std::this_thread::sleep_for(3 * kQuick.beat);
  } while (read_file(out() / "results.owner") != other);
  EXPECT_THROW(scratch->publish(), InputError);
  scratch.reset();
  EXPECT_FALSE(fs::exists(out() / "results.sqlite"));
  EXPECT_FALSE(fs::is_empty(disk()));  // not lost
}

TEST_F(Scratch, SaysWhereTheRunsAreIfTheFolderCannotBeWritten) {
  auto scratch = open();
  scratch->store().add(record(0, 0, "plain"));
  fs::create_directories(out() / "results.sqlite.part" / "in the way");
  try {
    scratch->publish();
    FAIL() << "published";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr(out().string()));
    EXPECT_THAT(error.what(), HasSubstr("what is done is in " + disk().string()));
  }
  scratch.reset();
  fs::remove_all(out() / "results.sqlite.part");
  { const auto again = open(); }
  EXPECT_EQ(published(), 1u);
}

}  // namespace
}  // namespace fathom
