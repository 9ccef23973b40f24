// A store that is written on a disk of this machine and published elsewhere.

#include "fathom/results/scratch_store.hpp"

#include <cstdlib>
#include <memory>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "results/stored_runs.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using std::chrono_literals::operator""ms;
using test::description;
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
  const pid_t child = ::fork();
  if (child == 0) {
    auto scratch = open();
    scratch->store().add(record(0, 1, "plain"));
    scratch->store().add(record(1, 0, "plain"));
    ::_exit(0);  // without a destructor
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(published(), 1u);
  { const auto scratch = open(); }
  EXPECT_EQ(published(), 3u);
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

TEST_F(Scratch, WritesNothingMoreWhereAnotherMachineTookOver) {
  auto scratch = open();
  scratch->store().add(record(0, 0, "plain"));
  write_file(out() / "results.owner", "elsewhere 1 another-boot 0 0\n");
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
