#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <functional>
#include <limits>

namespace fathom::test {

/// Between 8 (linear) and 64 (by the square), with room for n log n, caches and a busy machine.
inline constexpr double kFarBelowTheSquare = 25.0;

/// How many times as much processor time `run` takes for eight times its size: the least of several
/// tries, so that what disturbs one of them does not count.
inline double growth_of(const std::function<void(std::size_t)>& run, std::size_t size) {
  const auto ticks = [&](std::size_t of_size) {
    const std::clock_t begin = std::clock();
    run(of_size);
    return static_cast<double>(std::clock() - begin);
  };
  double least = std::numeric_limits<double>::infinity();
  for (int tries = 0; tries < 5 && least >= kFarBelowTheSquare; ++tries) {
    const double small = std::max(ticks(size), 1.0);
    least = std::min(least, ticks(8 * size) / small);
  }
  return least;
}

}  // namespace fathom::test
