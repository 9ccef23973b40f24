#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace fathom {

/// A series of numbers in six, in the series' own unit.
struct Summary {
  std::size_t count = 0;
  double mean = 0.0;
  double median = 0.0;
  double p95 = 0.0;
  double max = 0.0;
  double total = 0.0;
};

/// Nothing of an empty series. A NaN in the series makes all but `count` NaN.
std::optional<Summary> summarise(std::span<const double> values);

/// The quantile of a series by linear interpolation between order statistics, at rank
/// (n − 1) · probability counted from 0 (definition 7 of Hyndman and Fan 1996, the default of NumPy
/// and R). Of 1 … 5: median 3, 95th percentile 4.8. NaN where the series holds one.
/// Throws InputError on an empty series or a probability outside [0, 1].
double quantile(std::span<const double> values, double probability);

}  // namespace fathom
