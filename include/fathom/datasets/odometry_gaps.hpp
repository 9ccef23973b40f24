#pragma once

#include <optional>

#include "fathom/core/options.hpp"
#include "fathom/datasets/gap_options.hpp"

namespace fathom {

/// Where recorded dead reckoning has holes, and what is declared of them.
struct OdometryGaps {
  /// A time between two rows that is so many times the median one, or longer, is a hole, and the
  /// time of pictures before the first row and after the last one; absent: there are none.
  std::optional<double> least_intervals;
  GapOptions declared;

  /// Keys `gap_intervals`, and those of GapOptions.
  void describe(OptionTable& table);
};

}  // namespace fathom
