#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "fathom/vision/matching.hpp"

namespace fathom {

// A cost is the squared Euclidean distance of two descriptors, or the number of differing bits.
// While rows are compared Nearest holds costs; they become distances at the end.

/// The nearest row of `from` for each row of `to`, among the rows of `from` seen so far.
struct NearestBack {
  std::vector<int> row;
  std::vector<float> cost;

  explicit NearestBack(int to_rows)
      : row(static_cast<std::size_t>(to_rows), -1),
        cost(static_cast<std::size_t>(to_rows), std::numeric_limits<float>::infinity()) {}

  /// Of equal costs the lower row: the result does not depend on the order of merging.
  void merge(const NearestBack& other);
};

/// Most columns that are looked at side by side.
inline constexpr std::size_t kMostLanes = 16;

/// The nearest rows of `to` for a row of `from`, by its cost to each of them. The same look at the
/// costs brings `back` up to date. `count` is a multiple of kMostLanes; the costs beyond the last
/// row of `to` are infinite.
Nearest scan_row(int row, const float* costs, std::size_t count, NearestBack& back);

}  // namespace fathom
