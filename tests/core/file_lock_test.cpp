#include "fathom/core/file_lock.hpp"

#include <atomic>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>

#include "core/few_descriptors.hpp"
#include "fathom/core/environment_error.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::TemporaryFolder;
using ::testing::HasSubstr;

TEST(FileLock, KeepsASecondOneOutAndLeavesNothing) {
  const TemporaryFolder folder;
  {
    const FileLock lock(folder / "lock", "busy");
    EXPECT_TRUE(FileLock::is_held(folder / "lock"));
    EXPECT_EQ(test::input_error_of([&] { FileLock(folder / "lock", "busy"); }), "busy");
  }
  EXPECT_FALSE(FileLock::is_held(folder / "lock"));
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

// The file goes with its holder. One that had opened it before must not hold what nobody finds.
TEST(FileLock, HasOneHolderHoweverTheyTakeTurns) {
  const TemporaryFolder folder;
  std::atomic<int> holders = 0;
  std::atomic<int> held = 0;
  std::atomic<int> most = 0;
  {
    std::vector<std::jthread> threads;
    for (int i = 0; i < 4; ++i) {
      threads.emplace_back([&] {
        for (int tries = 0; tries < 20'000; ++tries) {
          try {
            const FileLock lock(folder / "lock", "busy");
            const int now = ++holders;
            if (now > most) most = now;
            ++held;
            --holders;
          } catch (const InputError&) {
          }
        }
      });
    }
  }
  EXPECT_EQ(most, 1);
  EXPECT_GT(held, 1000);
}

TEST(FileLock, OfAFileThatCannotBeMadeIsAFaultOfTheEnvironment) {
  const TemporaryFolder folder;
  EXPECT_THROW(FileLock(folder / "none/lock", "busy"), EnvironmentError);
  EXPECT_THAT(test::input_error_of([&] {
                const test::FewDescriptors none_left;
                FileLock(folder / "lock", "busy");
              }),
              HasSubstr("cannot be written: Too many open files"));
}

}  // namespace
}  // namespace fathom
