#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "fathom/evaluation/interval.hpp"

namespace fathom {

/// One figure over the trials of a Monte-Carlo study, in the figure's own unit.
struct Moments {
  std::size_t count = 0;
  double mean = 0.0;
  std::optional<double> standard_deviation;  ///< with n − 1; nothing of a single value
  double median = 0.0;
  double min = 0.0;
  double max = 0.0;
};

/// Nothing of an empty series. A NaN in the series makes all but `count` NaN.
std::optional<Moments> moments(std::span<const double> values);

struct BootstrapOptions {
  double probability = 0.95;     ///< that the interval holds the true mean; between 0 and 1
  std::size_t resamples = 2000;  ///< at least 1; with 2000 an end varies by 2 % of the width (1σ)
  std::uint64_t seed = 1;        ///< of the stream `bootstrap`: same seed, same interval
};

/// Bootstrap interval of the mean of independent trials: bias-corrected and accelerated (BCa, Efron
/// 1987), resampling the values with replacement, with the acceleration from the jackknife. It
/// needs no normal distribution and may be as skewed as the values are. Both ends are moved away
/// from the mean by t / z · √(n / (n − 1)), as of few values the bootstrap alone is too narrow (of
/// 10 normal ones 90 % in place of 95 %). It knows no tail beyond the largest value: of
/// heavy-tailed ones it remains too narrow (docs/study_statistics.md has the coverage).
///
/// Nothing of fewer than two values; [v, v] where all are v. Throws InputError on a value that is
/// not finite and on options outside their bounds.
std::optional<Interval> bootstrap_interval(std::span<const double> values,
                                           const BootstrapOptions& options = {});

/// The BCa interval of any statistic (Efron and Tibshirani 1993, equations 14.9 to 14.15):
/// `estimate` of all values, `replicates` of the resamples, `jackknife[i]` of all values but the
/// i-th. A replicate that equals the estimate counts half as below it. Where all replicates lie on
/// one side, half a replicate is taken to lie on the other, which keeps the bias finite; where all
/// of the jackknife is equal, the acceleration is 0.
/// Throws InputError without replicates or jackknife, on a number that is not finite and unless
/// 0 < probability < 1.
Interval bca_interval(double estimate, std::span<const double> replicates,
                      std::span<const double> jackknife, double probability);

}  // namespace fathom
