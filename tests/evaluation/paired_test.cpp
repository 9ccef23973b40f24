#include "fathom/evaluation/paired.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

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

// SciPy 1.10.1: scipy.stats.wilcoxon(d), and k = np.arange(1, n + 1),
//   scipy.stats.wilcoxon(k * np.where(k % 3 == 0, -1.0, 1.0)) for n = 50 and 51
TEST(SignedRank, RecordedNumbers) {
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
  EXPECT_NEAR(first_approximate.p_value.value(), 0.055852182035584695, 1e-14);
}

// SciPy 1.10.1: scipy.stats.wilcoxon(d, zero_method='wilcox', method='approx'), with the zeros and
// without.
TEST(SignedRank, RecordedNumbersWithTies) {
  const std::vector<double> with_zeros{3, 0, -1, 2, 2, 0, -2, 5, 1, 4, -1, 3, 6, 2, -3, 7, 1, -0.0};
  std::vector<double> without = with_zeros;
  without.erase(std::remove(without.begin(), without.end(), 0.0), without.end());
  for (const auto& differences : {with_zeros, without}) {
    const auto result = wilcoxon_signed_rank(differences);
    EXPECT_EQ(result.count, 15U);
    EXPECT_EQ(result.statistic, 21.5);
    EXPECT_EQ(result.positive_rank_sum, 98.5);
    EXPECT_FALSE(result.exact);
    EXPECT_NEAR(result.p_value.value(), 0.027998238281573294, 1e-14);
  }
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

TEST(SignedRank, CountingAllChoicesOfSigns) {
  for (int n = 1; n <= 9; ++n) {
    const int total = n * (n + 1) / 2;
    std::vector<int> ways(static_cast<std::size_t>(total) + 1, 0);
    for (int signs = 0; signs < (1 << n); ++signs) {
      int sum = 0;
      for (int rank = 1; rank <= n; ++rank) sum += (signs >> (rank - 1) & 1) * rank;
      ++ways[static_cast<std::size_t>(sum)];
    }
    for (int w = 0; w <= total; ++w) {
      int at_least_as_far = 0;
      for (int other = 0; other <= total; ++other) {
        const bool as_far = std::abs(2 * other - total) >= std::abs(2 * w - total);
        if (as_far) at_least_as_far += ways[static_cast<std::size_t>(other)];
      }
      const auto result = wilcoxon_signed_rank(with_rank_sum(n, w));
      EXPECT_EQ(result.positive_rank_sum, w);
      EXPECT_DOUBLE_EQ(result.p_value.value(), at_least_as_far / std::exp2(n)) << n << " " << w;
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

// The example of the documentation of Pingouin's holm(), and that of Wikipedia's article on the
// Holm–Bonferroni method, of which two are rejected at 0.05.
TEST(Holm, WorkedExamples) {
  EXPECT_THAT(holm(std::vector<double>{.50, .003, .32, .054, .0003}),
              Pointwise(DoubleNear(1e-15), {.64, .012, .64, .162, .0015}));
  EXPECT_THAT(holm(std::vector<double>{.01, .04, .03, .005}),
              Pointwise(DoubleNear(1e-15), {.03, .06, .06, .02}));
}

// By the definition: the largest of (m − number below) · q over all q up to p, cut at 1.
TEST(Holm, NaiveImplementation) {
  RandomStream random(4, "holm");
  for (int round = 0; round < 200; ++round) {
    std::vector<double> p(1 + random.index(12));
    for (double& value : p) value = std::round(20.0 * std::pow(random.uniform(), 3)) / 20.0;
    const std::vector<double> adjusted = holm(p);
    ASSERT_EQ(adjusted.size(), p.size());
    for (std::size_t i = 0; i < p.size(); ++i) {
      double expected = 0.0;
      for (const double q : p) {
        const auto below = std::count_if(p.begin(), p.end(), [&](double r) { return r < q; });
        const double left = static_cast<double>(p.size()) - static_cast<double>(below);
        if (q <= p[i]) expected = std::max(expected, std::min(1.0, left * q));
      }
      EXPECT_DOUBLE_EQ(adjusted[i], expected);
    }
  }
}

TEST(Holm, EndsAndRefusals) {
  EXPECT_TRUE(holm({}).empty());
  EXPECT_EQ(holm(std::vector<double>{0.04}), std::vector<double>{0.04});
  EXPECT_EQ(holm(std::vector<double>{1, 0, 0.9}), (std::vector<double>{1, 0, 1}));
  for (const double bad : {-0.01, 1.01, kNaN}) {
    EXPECT_THAT(input_error_of([&] {
                  holm(std::vector<double>{0.5, bad});
                }),
                HasSubstr("from 0 to 1"));
  }
}

TEST(PairedDifference, IsOfTheDifferences) {
  const std::vector<double> a{5.5, 3.0, 9.25, 4.0, 6.0};
  const std::vector<double> b{4.0, 3.5, 6.00, 4.0, 5.0};
  const std::vector<double> differences{1.5, -0.5, 3.25, 0.0, 1.0};
  const BootstrapOptions options{.probability = 0.9, .resamples = 500, .seed = 2};
  const auto result = paired_difference(a, b, options);
  ASSERT_TRUE(result && result->interval);
  EXPECT_EQ(result->count, 5U);
  EXPECT_DOUBLE_EQ(result->mean, 1.05);
  const auto interval = bootstrap_interval(differences, options);
  EXPECT_EQ(result->interval->low, interval->low);
  EXPECT_EQ(result->interval->high, interval->high);
  EXPECT_EQ(result->signed_rank.count, 4U);
  EXPECT_EQ(result->signed_rank.positive_rank_sum, 9.0);
  EXPECT_DOUBLE_EQ(result->signed_rank.p_value.value(), 0.25);  // 4 of 16 choices of signs
}

TEST(PairedDifference, TheSameListTwice) {
  const std::vector<double> a{5.5, 3.0, 9.25};
  const auto result = paired_difference(a, a);
  ASSERT_TRUE(result && result->interval);
  EXPECT_EQ(result->mean, 0.0);
  EXPECT_EQ(result->interval->low, 0.0);
  EXPECT_EQ(result->interval->high, 0.0);
  EXPECT_FALSE(result->signed_rank.p_value);
}

TEST(PairedDifference, OfOneTrialAndOfNone) {
  const auto one = paired_difference(std::vector<double>{3.0}, std::vector<double>{1.0});
  ASSERT_TRUE(one);
  EXPECT_EQ(one->mean, 2.0);
  EXPECT_FALSE(one->interval);
  EXPECT_EQ(one->signed_rank.p_value.value(), 1.0);
  EXPECT_FALSE(paired_difference({}, {}));
}

TEST(PairedDifference, Refuses) {
  const std::vector<double> two{1.0, 2.0};
  EXPECT_THAT(input_error_of([&] { paired_difference(two, std::vector<double>{1.0}); }),
              HasSubstr("got 2 and 1"));
  for (const double bad : {kNaN, kInfinity}) {
    const std::vector<double> with_bad{1.0, bad};
    EXPECT_THAT(input_error_of([&] { paired_difference(two, with_bad); }), HasSubstr("finite"));
    EXPECT_THAT(input_error_of([&] { paired_difference(with_bad, two); }), HasSubstr("finite"));
  }
  EXPECT_THAT(input_error_of([&] { paired_difference(two, two, {.resamples = 0}); }),
              HasSubstr("at least 1 resample"));
}

}  // namespace
}  // namespace fathom
