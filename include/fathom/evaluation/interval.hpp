#pragma once

namespace fathom {

/// Closed: both ends belong to it.
struct Interval {
  double low = 0.0;
  double high = 0.0;

  bool contains(double value) const { return value >= low && value <= high; }
};

}  // namespace fathom
