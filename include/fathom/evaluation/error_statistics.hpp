#pragma once

#include <optional>
#include <span>

namespace fathom {

/// Of a list of errors, which are not negative; in their unit, and `sse` in its square.
struct ErrorStatistics {
  double rmse = 0.0;
  double mean = 0.0;
  double median = 0.0;  ///< of an even number, the mean of the two in the middle
  double std = 0.0;     ///< about the mean, divided by n
  double min = 0.0;
  double max = 0.0;
  double sse = 0.0;  ///< sum of squares
};

/// Nothing of an empty list, and where any is not finite or too large to be squared.
std::optional<ErrorStatistics> error_statistics(std::span<const double> errors);

}  // namespace fathom
