// The front end matches on several threads at a time. What they call below must stand that: an
// OpenBLAS without locks gave some of a hundred products of two threads wrong.

#include <atomic>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "fathom/core/random.hpp"
#include "fathom/vision/matching.hpp"

namespace fathom {
namespace {

Features random_features(int rows, std::uint64_t seed) {
  RandomStream random(seed);
  Features features;
  features.pixels.resize(static_cast<std::size_t>(rows));
  cv::Mat_<float> descriptors(rows, 128);
  for (float& value : descriptors) value = static_cast<float>(random.index(256));
  features.descriptors = descriptors;
  return features;
}

bool is_same(const std::vector<Nearest>& a, const std::vector<Nearest>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].row != b[i].row || a[i].distance != b[i].distance ||
        a[i].next_distance != b[i].next_distance) {
      return false;
    }
  }
  return true;
}

TEST(FindNearest, IsTheSameOnManyThreadsAtATime) {
  constexpr int kThreads = 4;
  constexpr int kRepeats = 4000;
  const Features from = random_features(128, 1);
  const Features to = random_features(60, 2);
  const NearestRows alone = find_nearest(from, to);
  std::atomic<int> different = 0;
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < kThreads; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < kRepeats; ++i) {
          const NearestRows found = find_nearest(from, to);
          if (!is_same(found.in_to, alone.in_to) || !is_same(found.in_from, alone.in_from)) {
            ++different;
          }
        }
      });
    }
  }
  EXPECT_EQ(different, 0) << "of " << kThreads * kRepeats;
}

}  // namespace
}  // namespace fathom
