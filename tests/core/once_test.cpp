#include "fathom/core/once.hpp"

#include <barrier>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(Once, IsDoneByOneOfTheThreadsThatAsk) {
  Once once;
  int done = 0;  // no atomic: what is done is seen by all
  std::vector<int> seen(8);
  std::barrier begin(8);
  std::vector<std::thread> threads;
  for (int& one : seen) {
    threads.emplace_back([&] {
      begin.arrive_and_wait();
      once.call([&] {
        std::this_thread::sleep_for(std::chrono::milliseconds(20));  // others ask meanwhile
        ++done;
      });
      one = done;
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(seen, std::vector<int>(8, 1));
}

TEST(Once, WhatThrowsIsDoneAgain) {
  Once once;
  int done = 0;
  EXPECT_THROW(once.call([] { throw std::runtime_error("not yet"); }), std::runtime_error);
  once.call([&] { ++done; });
  once.call([&] { ++done; });
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace fathom
