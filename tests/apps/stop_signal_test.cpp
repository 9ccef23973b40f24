// Work that does not look whether it is to stop: ended with the program where a person waits.

#include "apps/stop_signal.hpp"

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include <gtest/gtest.h>

#include "apps/command.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

// Until the program is ended.
[[noreturn]] void work_on() {
  while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
}

TEST(StopSignalDeathTest, KeepsWhatThereIsAndEndsTheProgram) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  // The program that dies comes here again, in a process of its own.
  const test::TemporaryFolder folder;
  ::setenv("FATHOM_TEST_KEPT", (folder.path() / "kept").c_str(), 0);
  const std::filesystem::path kept = std::getenv("FATHOM_TEST_KEPT");
  const auto work = [&kept] {
    const StopSignal stop(false, [&kept] { std::ofstream(kept) << "kept"; });
    std::raise(SIGINT);
    work_on();
  };
  EXPECT_EXIT(work(), ::testing::ExitedWithCode(kStopped),
              "stopping: (.|\n)*stopped in the middle of a trial");
  EXPECT_TRUE(std::filesystem::exists(kept));
  ::unsetenv("FATHOM_TEST_KEPT");
}

TEST(StopSignalDeathTest, TheSecondEndsItAtOnce) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto work = [] {
    const StopSignal stop(true, [] {});
    std::raise(SIGTERM);
    std::raise(SIGTERM);
    work_on();
  };
  EXPECT_EXIT(work(), ::testing::KilledBySignal(SIGTERM), "^$");
}

TEST(StopSignalDeathTest, WorkThatLooksIsLeftInPeace) {
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto work = [] {
    {
      const StopSignal stop(true, [] { std::abort(); });
      std::raise(SIGINT);
      if (!*stop.flag()) std::abort();
    }
    std::this_thread::sleep_for(std::chrono::seconds(3));
    std::exit(7);
  };
  EXPECT_EXIT(work(), ::testing::ExitedWithCode(7), "^$");
}

}  // namespace
}  // namespace fathom
