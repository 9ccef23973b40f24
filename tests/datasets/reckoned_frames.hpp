#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "fathom/core/random.hpp"
#include "fathom/datasets/reading_carrier.hpp"
#include "support/planar.hpp"

/// Dead reckoning that readings are carried by.
namespace fathom::test {

inline constexpr std::int64_t kFrame = 1'000'000'000;

/// A turning way of seven frames, a second apart.
inline std::vector<DeadReckonedFrame> frames_with_holes(
    const std::vector<std::size_t>& holes = {}) {
  RandomStream random(3);
  std::vector<DeadReckonedFrame> frames{{0, {}, false}};
  for (std::size_t i = 1; i < 7; ++i) {
    frames.push_back({static_cast<std::int64_t>(i) * kFrame,
                      {{0.5, 0.1, 0.3}, random_covariance(random, 1e-4)},
                      std::ranges::find(holes, i) != holes.end()});
  }
  return frames;
}

inline ReckonedFrames over(const std::vector<DeadReckonedFrame>& frames) {
  return {frames.size(), [&frames](std::size_t i) { return frames[i]; }};
}

}  // namespace fathom::test
