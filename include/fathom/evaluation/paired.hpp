#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "fathom/evaluation/clustered.hpp"
#include "fathom/evaluation/interval.hpp"
#include "fathom/evaluation/signed_rank.hpp"
#include "fathom/evaluation/statistics.hpp"

namespace fathom {

/// Holm's step-down adjustment (1979) of the p-values of a family of tests, in the order given: a
/// test rejected at level α by its adjusted value keeps the family-wise error rate at α or below,
/// however the tests depend on each other. Ordered as the p-values, at most 1. Throws InputError on
/// a p-value outside [0, 1].
std::vector<double> holm(std::span<const double> p_values);

/// One figure of two methods over the same trials.
struct PairedDifference {
  std::size_t count = 0;             ///< of what is tested: trials, or surveys
  std::size_t trials = 0;            ///< that both methods have the figure of
  bool is_over_surveys = false;      ///< whether `count` is of surveys, else of trials
  double mean = 0.0;                 ///< of a − b
  std::optional<Interval> interval;  ///< of that mean, by bootstrap; nothing of a single trial
  SignedRankTest signed_rank;        ///< of the differences

  /// Of skewed differences mean and ranks may point to opposite sides: then p is not of the mean's.
  bool is_on_one_side() const;
};

/// `a[i]` and `b[i]` are of trial i. Nothing without trials. A trial that failed has no figure: the
/// caller leaves it out of both lists and says how many those were.
/// Throws InputError where the lists differ in length, on a value that is not finite and on options
/// outside their bounds.
std::optional<PairedDifference> paired_difference(std::span<const double> a,
                                                  std::span<const double> b,
                                                  const BootstrapOptions& options = {});

/// The same of the differences a − b by survey. Of several surveys mean, interval and test are over
/// the surveys' mean differences, as trials of one survey are no independent draws; of a single one
/// over its trials, which says nothing of other surveys. A trial that either method failed has no
/// difference; a survey without any is not there.
std::optional<PairedDifference> difference_over_surveys(const ClusteredValues& differences,
                                                        const BootstrapOptions& options = {});

/// The signed-rank test of it alone. Nothing without differences.
std::optional<SignedRankTest> test_over_surveys(const ClusteredValues& differences);

}  // namespace fathom
