#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fathom/evaluation/interval.hpp"
#include "fathom/evaluation/statistics.hpp"

namespace fathom {

struct SignedRankTest {
  std::size_t count = 0;           ///< of differences that are not 0
  double positive_rank_sum = 0.0;  ///< W⁺
  double statistic = 0.0;          ///< min(W⁺, W⁻)
  std::optional<double> p_value;   ///< two-sided; nothing where `count` is 0
  bool exact = false;              ///< from the exact distribution, not the normal one
};

/// Wilcoxon's signed-rank test (1945) that differences are symmetric about 0. Zeros are dropped, as
/// Wilcoxon did; equal magnitudes share their mean rank. The p-value is exact for up to 50
/// differences without equal magnitudes, and otherwise of the normal approximation with the
/// variance corrected for ties, without continuity correction.
/// Magnitudes are equal only to the last bit. Infinite ones rank highest. Throws InputError on NaN.
SignedRankTest wilcoxon_signed_rank(std::span<const double> differences);

/// Holm's step-down adjustment (1979) of the p-values of a family of tests, in the order given: a
/// test rejected at level α by its adjusted value keeps the chance of any false rejection in the
/// family at α or below, however the tests depend on each other. Ordered as the p-values, at
/// most 1. Throws InputError on a p-value outside [0, 1].
std::vector<double> holm(std::span<const double> p_values);

/// One figure of two methods over the same trials.
struct PairedDifference {
  std::size_t count = 0;             ///< of trials
  double mean = 0.0;                 ///< of a − b
  std::optional<Interval> interval;  ///< of that mean, by bootstrap; nothing of a single trial
  SignedRankTest signed_rank;        ///< of the differences
};

/// `a[i]` and `b[i]` are of trial i. Nothing without trials. A trial that failed has no figure: the
/// caller leaves it out of both lists and says how many those were.
/// Throws InputError where the lists differ in length, on a value that is not finite and on options
/// outside their bounds.
std::optional<PairedDifference> paired_difference(std::span<const double> a,
                                                  std::span<const double> b,
                                                  const BootstrapOptions& options = {});

}  // namespace fathom
