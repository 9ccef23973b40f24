#pragma once

#include <cstddef>
#include <optional>
#include <span>

namespace fathom {

struct SignedRankTest {
  std::size_t count = 0;           ///< of differences that are not 0
  double positive_rank_sum = 0.0;  ///< W⁺
  double statistic = 0.0;          ///< min(W⁺, W⁻)
  std::optional<double> p_value;   ///< two-sided; nothing where `count` is 0
  bool exact = false;              ///< from the permutation distribution, not the normal one
};

/// Wilcoxon's signed-rank test (1945) of the hypothesis that differences are symmetric about 0.
///
/// Equal magnitudes share their mean rank; magnitudes are equal only to the last bit, and infinite
/// ones rank highest. Zeros are dropped before the ranking, as Wilcoxon did and as R and SciPy do
/// unless told otherwise; Pratt (1959) ranks them first and drops them afterwards. Two estimators
/// that differ by exactly 0 in a trial did the same thing there (mostly neither closed a loop), and
/// such a trial must not change the weight of the others.
///
/// The p-value is P(|W⁺ − μ| ≥ |w⁺ − μ|), μ half the sum of ranks. The distribution of W⁺ is
/// symmetric, so this is 2 P(W⁺ ≤ min(w⁺, w⁻)), at most 1. Up to 50 differences it is exact: all 2ⁿ
/// choices of signs of the ranks at hand, ties included, are equally likely. The least p of n
/// differences is 2^(1 − n), so fewer than 6 can never reach 0.05. Of more than 50 it is that of
/// the normal approximation, with the variance corrected for ties and a continuity correction
/// of ½. Throws InputError on NaN.
SignedRankTest wilcoxon_signed_rank(std::span<const double> differences);

}  // namespace fathom
