// Claims of a folder that machines share.

#include "fathom/core/folder_claim.hpp"

#include <fstream>
#include <memory>
#include <string>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/system.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using std::chrono_literals::operator""ms;
using test::TemporaryFolder;
using ::testing::HasSubstr;

constexpr ClaimTimes kQuick{20ms, 400ms};

TEST(FolderClaim, KeepsASecondOneOutAndLeavesNothing) {
  const TemporaryFolder folder;
  {
    const FolderClaim claim(folder.path(), kQuick);
    claim.require_held();
    try {
      const FolderClaim other(folder.path(), kQuick);
      FAIL() << "two at once";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("process " + std::to_string(::getpid()) + " on "));
    }
    const ClaimHolder holder = FolderClaim::holder_of(folder.path(), kQuick);
    EXPECT_TRUE(holder.is_alive);
    EXPECT_EQ(holder.process, ::getpid());
  }
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
  EXPECT_FALSE(FolderClaim::holder_of(folder.path(), kQuick).is_alive);
  const FolderClaim next(folder.path(), kQuick);
}

// Killed outright on this machine: nothing to wait for. Its own patience is an hour.
TEST(FolderClaim, OfADeadProcessIsTakenOverAtOnce) {
  const TemporaryFolder folder;
  const pid_t child = ::fork();
  if (child == 0) {
    new FolderClaim(folder.path(), kQuick);
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_TRUE(std::filesystem::exists(folder.path() / "results.owner"));
  // It may have been killed as it wrote.
  const std::string mark = process_mark();
  const std::string left_by_it =
      "results.owner.partial-" + std::to_string(child) + mark.substr(mark.find('-'));
  std::ofstream(folder.path() / left_by_it).flush();
  const FolderClaim claim(folder.path(), {20ms, 3'600'000ms});
  claim.require_held();
  const std::filesystem::directory_iterator left(folder.path());
  EXPECT_EQ(std::distance(begin(left), end(left)), 1);
}

// Another machine's claim that no longer changes, whatever its clock says: the file's time is of
// the next century.
TEST(FolderClaim, OfASilentMachineIsTakenOverAfterPatience) {
  const TemporaryFolder folder;
  write_file(folder.path() / "results.owner", "elsewhere 1 another-boot 0 7\n");
  std::filesystem::last_write_time(
      folder.path() / "results.owner",
      std::filesystem::file_time_type::clock::now() + std::chrono::hours(24 * 365 * 80));
  EXPECT_FALSE(FolderClaim::holder_of(folder.path(), kQuick).is_alive);
  const FolderClaim claim(folder.path(), kQuick);
  claim.require_held();
}

// Another machine's claim that beats.
TEST(FolderClaim, OfALivingMachineIsRefused) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "results.owner";
  write_file(file, "elsewhere 1 another-boot 0 0\n");
  std::jthread beats([&file](const std::stop_token& stop) {
    for (int i = 1; !stop.stop_requested(); ++i) {
      write_file(file, "elsewhere 1 another-boot 0 " + std::to_string(i) + "\n");
      std::this_thread::sleep_for(10ms);
    }
  });
  try {
    const FolderClaim claim(folder.path(), kQuick);
    FAIL() << "two machines at once";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("process 1 on elsewhere is at work on it"));
  }
  EXPECT_THROW(FolderClaim::require_free(folder.path(), kQuick), InputError);
  beats.request_stop();
  beats.join();
  FolderClaim::require_free(folder.path(), kQuick);
}

// One that slept while another took over must not write there any more.
TEST(FolderClaim, SaysWhenItIsLost) {
  const TemporaryFolder folder;
  const FolderClaim claim(folder.path(), kQuick);
  write_file(folder.path() / "results.owner", "elsewhere 1 another-boot 0 0\n");
  EXPECT_THROW(claim.require_held(), InputError);
  std::this_thread::sleep_for(60ms);
  EXPECT_THAT(read_file(folder.path() / "results.owner"), HasSubstr("elsewhere"));
  // The other has ended.
  std::filesystem::remove(folder.path() / "results.owner");
  try {
    claim.require_held();
    FAIL() << "held";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("another process has taken it over, and ended"));
  }
}

}  // namespace
}  // namespace fathom
