#include "fathom/core/workers.hpp"

#include <ctime>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom {
namespace {

using ::testing::Each;

double own_seconds() {
  std::timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

TEST(Workers, EachDoesItsPartOfEveryTask) {
  for (const int threads : {1, 2, 5}) {
    Workers workers(threads);
    ASSERT_EQ(workers.size(), threads);
    std::vector<int> calls(static_cast<std::size_t>(threads), 0);
    for (int task = 0; task < 200; ++task) {
      workers.run([&](int part) { ++calls[static_cast<std::size_t>(part)]; });
    }
    EXPECT_THAT(calls, Each(200));
  }
}

TEST(Workers, TheCallerDoesTheFirstPart) {
  Workers workers(3);
  std::thread::id first;
  workers.run([&](int part) {
    if (part == 0) first = std::this_thread::get_id();
  });
  EXPECT_EQ(first, std::this_thread::get_id());
}

TEST(Workers, RangesCoverAllOnce) {
  Workers workers(3);
  for (Workers* const who : {static_cast<Workers*>(nullptr), &workers}) {
    for (const std::size_t count : {0u, 1u, 10u, 11u, 1000u}) {
      std::vector<int> seen(count, 0);
      for_ranges(who, count, 10, [&](std::size_t begin, std::size_t end) {
        ASSERT_LT(begin, end);
        for (std::size_t i = begin; i < end; ++i) ++seen[i];
      });
      EXPECT_THAT(seen, Each(1));
    }
  }
}

// A part that left the barrier before all had reached it would see a sum that lacks some.
TEST(Barrier, ShowsWhatAllHaveWritten) {
  constexpr int kParts = 4;
  Workers workers(kParts);
  Barrier barrier(kParts);
  std::vector<int> written(kParts, 0);
  std::vector<int> wrong(kParts, 0);
  workers.run([&](int part) {
    for (int round = 1; round <= 300; ++round) {
      written[static_cast<std::size_t>(part)] = round;
      barrier.wait();
      for (const int other : written) wrong[static_cast<std::size_t>(part)] += other != round;
      barrier.wait();
    }
  });
  EXPECT_THAT(wrong, Each(0));
}

TEST(ThreadProcessorSeconds, CountsWhatHelpersDid) {
  constexpr double kWorkS = 0.02;
  Workers workers(2);
  const double own_before = own_seconds();
  const double before = thread_processor_seconds();
  workers.run([&](int part) {
    if (part == 0) return;
    const double start = own_seconds();
    while (own_seconds() - start < kWorkS) {
    }
  });
  const double own = own_seconds() - own_before;
  EXPECT_GE(thread_processor_seconds() - before, kWorkS);
  EXPECT_LT(own, kWorkS);
}

}  // namespace
}  // namespace fathom
