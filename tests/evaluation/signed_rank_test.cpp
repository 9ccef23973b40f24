#include "fathom/evaluation/signed_rank.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "support/input_error.hpp"
#include "support/numbers.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::kInfinity;
using test::kNaN;
using testing::HasSubstr;

// 1 … n, each third negative.
std::vector<double> each_third_negative(int n) {
  std::vector<double> differences;
  for (int i = 1; i <= n; ++i) differences.push_back(i % 3 == 0 ? -i : i);
  return differences;
}

// The differences ±1 … ±n with W⁺ = w: any w is a sum of ranks taken greedily from the largest.
std::vector<double> with_rank_sum(int n, int w) {
  std::vector<double> differences;
  for (int rank = n; rank >= 1; --rank) {
    const bool positive = w >= rank;
    if (positive) w -= rank;
    differences.push_back(positive ? rank : -rank);
  }
  return differences;
}

// W⁺ and p of `d` without its zeros: R 4.2.2, exactRankTests 0.8-35, wilcox.exact(d); coin 1.4-2,
// wilcoxsign_test(rep(0, length(d)) ~ I(-d), distribution = "exact", zero.method = "Wilcoxon"), has
// the same p to all digits.
TEST(SignedRank, RecordedExactNumbersWithTiesAndZeros) {
  struct Row {
    std::vector<double> differences;
    std::size_t count;
    double positive_rank_sum;
    double p_value;
  };
  for (const auto& [differences, count, positive_rank_sum, p_value] : {
           Row{{1, 1, 1, 1, 1}, 5, 15, 0.0625},
           Row{{2, 2, 1, 1, -1}, 5, 13, 0.25},
           Row{{.5, .5, 1, 1, 2, 2, -.5}, 7, 26, 0.0625},
           Row{{.1, -.1, .2, .2, -.3, 0, -0.0, .4, .4, .4}, 8, 29.5, 0.1171875},
           Row{{3, 0, -1, 2, 2, 0, -2, 5, 1, 4, -1, 3, 6, 2, -3, 7, 1, -0.0},
               15,
               98.5,
               0.02716064453125},
           Row{{4, 4, 4, -4, 2, 2, -2, 1, 1, 3, 3, 3, 5, -5, 6, 6, 7, -1, 8, 8},
               20,
               177,
               0.0053119659423828125},
       }) {
    const auto result = wilcoxon_signed_rank(differences);
    EXPECT_TRUE(result.exact);
    EXPECT_EQ(result.count, count);
    EXPECT_EQ(result.positive_rank_sum, positive_rank_sum);
    EXPECT_DOUBLE_EQ(result.p_value.value(), p_value) << count;
  }
  // d <- ceiling((1:45) / 2) * ifelse((1:45) %% 3 == 0, -1, 1)
  std::vector<double> many = each_third_negative(45);
  for (double& d : many) d = std::copysign(std::ceil(std::abs(d) / 2.0), d);
  EXPECT_NEAR(wilcoxon_signed_rank(many).p_value.value(), 0.075699141689881344, 1e-14);
}

// SciPy 1.10.1: scipy.stats.wilcoxon(d), and k = np.arange(1, n + 1),
//   scipy.stats.wilcoxon(k * np.where(k % 3 == 0, -1.0, 1.0)) for n = 50, and for n = 51 with
//   correction=True, where R's wilcox.test(d, exact = FALSE, correct = TRUE) has
//   0.0564558053677022.
TEST(SignedRank, RecordedNumbersWithoutTies) {
  const auto few = wilcoxon_signed_rank(
      std::vector<double>{1.83, -0.50, 1.62, 2.48, 1.68, 1.88, 1.55, 3.06, -1.30, -0.11, 0.75});
  EXPECT_EQ(few.count, 11U);
  EXPECT_EQ(few.statistic, 7.0);
  EXPECT_EQ(few.positive_rank_sum, 59.0);
  EXPECT_TRUE(few.exact);
  EXPECT_DOUBLE_EQ(few.p_value.value(), 0.0185546875);

  const auto last_exact = wilcoxon_signed_rank(each_third_negative(50));
  EXPECT_EQ(last_exact.statistic, 408.0);
  EXPECT_TRUE(last_exact.exact);
  EXPECT_NEAR(last_exact.p_value.value(), 0.02616696817119646, 1e-14);

  const auto first_approximate = wilcoxon_signed_rank(each_third_negative(51));
  EXPECT_EQ(first_approximate.statistic, 459.0);
  EXPECT_FALSE(first_approximate.exact);
  EXPECT_NEAR(first_approximate.p_value.value(), 0.056455805367702186, 1e-14);
}

// R 4.2.2: d <- ((1:60) * 7) %% 13 - 4; wilcox.test(d, exact = FALSE, correct = TRUE)
TEST(SignedRank, RecordedApproximationWithTiesAndZeros) {
  std::vector<double> differences;
  for (int i = 1; i <= 60; ++i) differences.push_back(i * 7 % 13 - 4);
  const auto result = wilcoxon_signed_rank(differences);
  EXPECT_EQ(result.count, 55U);
  EXPECT_EQ(result.positive_rank_sum, 1195.5);
  EXPECT_FALSE(result.exact);
  EXPECT_NEAR(result.p_value.value(), 0.00035690217680662211, 1e-14);
}

// At its mean a statistic is no evidence at all, and the continuity correction does not reach past.
TEST(SignedRank, AnApproximatePValueIsAtMostOne) {
  std::vector<double> differences(60, 1.0);
  std::fill_n(differences.begin(), 30, -1.0);
  EXPECT_EQ(wilcoxon_signed_rank(differences).p_value.value(), 1.0);
}

// SciPy 1.10.1: scipy.stats.wilcoxon([1.5, -2.5, 3.5, -4, 5, 6, 7]); it would approximate with the
// zero in the list, for which there is no need once it is dropped.
TEST(SignedRank, ExactOnceZerosAreDropped) {
  const auto result = wilcoxon_signed_rank(std::vector<double>{1.5, -2.5, 0, 3.5, -4, 5, 6, 7});
  EXPECT_EQ(result.count, 7U);
  EXPECT_TRUE(result.exact);
  EXPECT_EQ(result.statistic, 6.0);
  EXPECT_DOUBLE_EQ(result.p_value.value(), 0.21875);
}

// |{signs: |W⁺ − μ| ≥ |w⁺ − μ|}| / 2ⁿ, all 2ⁿ of them written out. Twice a mean rank is 1 + the
// number of smaller magnitudes + that of magnitudes that are smaller or equal.
double p_value_by_enumeration(std::vector<double> differences) {
  std::erase(differences, 0.0);
  const std::size_t n = differences.size();
  std::vector<int> doubled_ranks;
  for (const double d : differences) {
    int doubled_rank = 1;
    for (const double other : differences) {
      if (std::abs(other) < std::abs(d)) ++doubled_rank;
      if (std::abs(other) <= std::abs(d)) ++doubled_rank;
    }
    doubled_ranks.push_back(doubled_rank);
  }
  // 2 W⁺ − 2 W⁻ = 4 (W⁺ − μ)
  const auto distance_of = [&](auto is_positive) {
    int signed_sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      signed_sum += is_positive(i) ? doubled_ranks[i] : -doubled_ranks[i];
    }
    return std::abs(signed_sum);
  };
  const int observed = distance_of([&](std::size_t i) { return differences[i] > 0.0; });
  std::size_t as_far = 0;
  for (std::size_t signs = 0; signs < (std::size_t{1} << n); ++signs) {
    if (distance_of([&](std::size_t i) { return (signs >> i & 1U) != 0; }) >= observed) ++as_far;
  }
  return static_cast<double>(as_far) / std::exp2(n);
}

TEST(SignedRank, EnumerationOfAllSigns) {
  RandomStream random(13, "signed rank enumeration");
  for (std::size_t n = 1; n <= 14; ++n) {
    for (const double step : {0.0, 0.25, 1.0}) {  // without ties, with some, with many and zeros
      std::vector<double> differences(n);
      for (double& d : differences) {
        d = 0.3 + random.normal();
        if (step > 0.0) d = step * std::round(d / step);
      }
      const auto result = wilcoxon_signed_rank(differences);
      if (result.count == 0) continue;
      EXPECT_DOUBLE_EQ(result.p_value.value(), p_value_by_enumeration(differences))
          << n << " " << step;
    }
  }
}

// Of the probabilities that the p-values imply: P(W⁺ = w) = (p(w) − p(w − 1)) / 2 below the centre.
// n(n + 1)/2 is odd for these n, so that the lower half holds exactly one half.
TEST(SignedRank, ExactDistributionHasTotalAndVariance) {
  for (const int n : {13, 25, 50}) {
    const int total = n * (n + 1) / 2;
    double probability = 0.0;
    double variance = 0.0;
    double previous = 0.0;
    for (int w = 0; 2 * w < total; ++w) {
      const double p = wilcoxon_signed_rank(with_rank_sum(n, w)).p_value.value();
      EXPECT_GT(p, previous);
      probability += p - previous;
      variance += (p - previous) * std::pow(w - 0.5 * total, 2);
      previous = p;
    }
    EXPECT_NEAR(probability, 1.0, 1e-12);
    const double expected = n * (n + 1) * (2 * n + 1) / 24.0;
    EXPECT_NEAR(variance, expected, 1e-9 * expected);
  }
}

TEST(SignedRank, TheOtherWayRoundTheSame) {
  RandomStream random(8, "signed rank");
  for (const std::size_t n : {3U, 20U, 70U}) {
    for (const double step : {0.0, 0.5}) {  // the second makes ties and zeros
      std::vector<double> differences(n);
      for (double& d : differences) {
        d = 0.3 + random.normal();
        if (step > 0.0) d = step * std::round(d / step);
      }
      std::vector<double> flipped = differences;
      for (double& d : flipped) d = -d;
      const auto one = wilcoxon_signed_rank(differences);
      const auto other = wilcoxon_signed_rank(flipped);
      const double rank_total = 0.5 * static_cast<double>(one.count * (one.count + 1));
      EXPECT_EQ(one.count, other.count);
      EXPECT_EQ(one.statistic, other.statistic);
      EXPECT_EQ(one.positive_rank_sum + other.positive_rank_sum, rank_total);
      EXPECT_EQ(one.p_value, other.p_value);
    }
  }
}

TEST(SignedRank, NothingWithoutDifferences) {
  for (const std::vector<double>& none : {std::vector<double>{}, std::vector<double>{0.0, -0.0}}) {
    const auto result = wilcoxon_signed_rank(none);
    EXPECT_EQ(result.count, 0U);
    EXPECT_FALSE(result.p_value);
  }
}

TEST(SignedRank, InfinityHasARankAndNaNNone) {
  const auto result = wilcoxon_signed_rank(std::vector<double>{kInfinity, 1, -2});
  EXPECT_EQ(result.positive_rank_sum, 4.0);
  EXPECT_THAT(input_error_of([] {
                wilcoxon_signed_rank(std::vector<double>{1, kNaN});
              }),
              HasSubstr("NaN"));
}

}  // namespace
}  // namespace fathom
