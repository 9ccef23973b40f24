#include "fathom/evaluation/statistics.hpp"

#include <cmath>
#include <cstdint>
#include <numeric>
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

const std::vector<double> kSkewed{0.25, 1, 1.5, 0.5, 7, 2, 0.75, 3, 1.25, 12, 0.5, 2.25};
const std::vector<double> kEven{4.1, 3.7, 5.2, 4.4, 3.9, 4.8, 4.6, 5.0,
                                4.2, 3.5, 4.7, 4.3, 5.6, 3.8, 4.5};

double mean_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

// NumPy 1.24: x.mean(), x.std(ddof=1), np.median(x), x.min(), x.max().
TEST(Moments, RecordedNumbers) {
  const std::vector<double> values{2.5, -1.0, 7.25, 3.0, 3.0, 11.5, 0.125, 4.0, 9.0, 6.0, 5.5};
  const auto result = moments(values);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->count, 11U);
  EXPECT_DOUBLE_EQ(result->mean, 4.625);
  ASSERT_TRUE(result->standard_deviation);
  EXPECT_DOUBLE_EQ(*result->standard_deviation, 3.7152557112532643);
  EXPECT_DOUBLE_EQ(result->median, 4.0);
  EXPECT_EQ(result->min, -1.0);
  EXPECT_EQ(result->max, 11.5);
}

TEST(Moments, FarFromZeroNothingIsLost) {
  const auto result = moments(std::vector<double>{1e9 + 4, 1e9 + 7, 1e9 + 13, 1e9 + 16});
  ASSERT_TRUE(result && result->standard_deviation);
  EXPECT_DOUBLE_EQ(*result->standard_deviation, std::sqrt(30.0));
}

TEST(Moments, OfOneValueAndOfNone) {
  const auto one = moments(std::vector<double>{-7.5});
  ASSERT_TRUE(one);
  EXPECT_FALSE(one->standard_deviation);
  for (const double value : {one->mean, one->median, one->min, one->max}) EXPECT_EQ(value, -7.5);
  EXPECT_FALSE(moments({}));
}

TEST(Moments, NaNIsNeverDropped) {
  for (const std::size_t at : {0U, 1U, 2U}) {
    std::vector<double> values{3, 1, 2};
    values[at] = kNaN;
    const auto result = moments(values);
    ASSERT_TRUE(result && result->standard_deviation);
    EXPECT_EQ(result->count, 3U);
    for (const double value :
         {result->mean, *result->standard_deviation, result->median, result->min, result->max}) {
      EXPECT_TRUE(std::isnan(value));
    }
  }
}

// Resamples by a formula, so that another tool has the same.
std::vector<double> formula_replicates(const std::vector<double>& values, std::uint64_t count) {
  std::vector<double> means;
  for (std::uint64_t b = 0; b < count; ++b) {
    double sum = 0.0;
    for (std::uint64_t i = 0; i < values.size(); ++i) {
      sum += values[(b * 7919 + i * 104729 + b * b * i * 31) % 1009 % values.size()];
    }
    means.push_back(sum / static_cast<double>(values.size()));
  }
  return means;
}

std::vector<double> jackknife_means(const std::vector<double>& values) {
  std::vector<double> means;
  for (std::size_t i = 0; i < values.size(); ++i) {
    std::vector<double> rest = values;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    means.push_back(mean_of(rest));
  }
  return means;
}

// SciPy 1.10.1 on the same replicates, x the values, B their number:
//   b, i = np.arange(B)[:, None], np.arange(len(x))
//   reps = x[(b * 7919 + i * 104729 + b * b * i * 31) % 1009 % len(x)].mean(axis=1)
//   low, high, _ = scipy.stats._resampling._bca_interval((x,), np.mean, -1, (1 - p) / 2, reps,
//   None) np.percentile(reps, 100 * low), np.percentile(reps, 100 * high)
TEST(BcaInterval, RecordedNumbers) {
  const std::vector<double> replicates = formula_replicates(kSkewed, 200);
  const std::vector<double> jackknife = jackknife_means(kSkewed);
  const Interval most = bca_interval(mean_of(kSkewed), replicates, jackknife, 0.95);
  EXPECT_NEAR(most.low, 1.1138145846961507, 1e-12);
  EXPECT_NEAR(most.high, 5.955962929433457, 1e-12);
  const Interval fewer = bca_interval(mean_of(kSkewed), replicates, jackknife, 0.8);
  EXPECT_NEAR(fewer.low, 1.6632415841222428, 1e-12);
  EXPECT_NEAR(fewer.high, 3.97897827816971, 1e-12);

  // 70 of these replicates equal the estimate.
  const std::vector<double> of_two_kinds{0, 0, 1, 0, 0, 1, 0, 1, 0, 0, 1, 0};
  const Interval tied = bca_interval(mean_of(of_two_kinds), formula_replicates(of_two_kinds, 199),
                                     jackknife_means(of_two_kinds), 0.95);
  EXPECT_NEAR(tied.low, 0.0, 1e-12);
  EXPECT_NEAR(tied.high, 0.5843254416005574, 1e-12);
}

TEST(BcaInterval, RoundingDoesNotSplitEqualReplicates) {
  std::vector<double> exact(40, 0.3);
  std::vector<double> rounded(40, 0.1 + 0.2);
  ASSERT_NE(exact[0], rounded[0]);
  for (int i = 0; i < 60; ++i) {
    exact.push_back(0.01 * i);
    rounded.push_back(0.01 * i);
  }
  const std::vector<double> jackknife{0.1, 0.2, 0.4};
  const Interval a = bca_interval(0.3, exact, jackknife, 0.9);
  const Interval b = bca_interval(0.3, rounded, jackknife, 0.9);
  EXPECT_NEAR(a.low, b.low, 1e-12);
  EXPECT_NEAR(a.high, b.high, 1e-12);
}

// With neither bias nor acceleration the plain percentiles, of the levels 0.1 and 0.9. With all
// replicates above the estimate the bias is Φ⁻¹(0.5 / 5), so that Φ(2 z₀ + z) is 0.1 again.
TEST(BcaInterval, ClosedForm) {
  const std::vector<double> replicates{1, 2, 3, 4, 5};
  const std::vector<double> level{2, 2};
  const Interval plain = bca_interval(3.0, replicates, level, 0.8);
  EXPECT_NEAR(plain.low, 1.4, 1e-12);
  EXPECT_NEAR(plain.high, 4.6, 1e-12);
  EXPECT_NEAR(bca_interval(0.0, replicates, level, 0.8).high, 1.4, 1e-12);
  EXPECT_NEAR(bca_interval(6.0, replicates, level, 0.8).low, 4.6, 1e-12);
}

// The acceleration is −0.15, or 0.15; where 1 − a (z₀ + z) falls below 0, the end is the last
// replicate.
TEST(BcaInterval, PastTheFormulasPole) {
  const std::vector<double> replicates{1, 2, 3, 4, 5};
  std::vector<double> skewed(20, 0.0);
  skewed.push_back(1.0);
  const Interval left = bca_interval(0.0, replicates, skewed, 1.0 - 1e-13);
  EXPECT_EQ(left.low, 1.0);
  EXPECT_GE(left.high, 1.0);
  skewed.back() = -1.0;
  const Interval right = bca_interval(6.0, replicates, skewed, 1.0 - 1e-13);
  EXPECT_LE(right.low, 5.0);
  EXPECT_EQ(right.high, 5.0);
}

// SciPy 1.10.1: scipy.stats.bootstrap((x,), np.mean, n_resamples=2000000, batch=100000,
//   method='BCa', random_state=1).confidence_interval; both ends moved away from the mean by
//   t / 1.959964 * sqrt(n / (n - 1)), t of 11 and of 14 degrees of freedom.
TEST(BootstrapInterval, RecordedNumbers) {
  const BootstrapOptions options{.resamples = 100000};
  const auto expect = [&options](const std::vector<double>& values, double t, const Interval& bca) {
    const auto n = static_cast<double>(values.size());
    const double widened = t / 1.959964 * std::sqrt(n / (n - 1.0));
    const double mean = mean_of(values);
    const auto interval = bootstrap_interval(values, options);
    ASSERT_TRUE(interval);
    const double near = 0.01 * (bca.high - bca.low);
    EXPECT_NEAR(interval->low, mean + widened * (bca.low - mean), near);
    EXPECT_NEAR(interval->high, mean + widened * (bca.high - mean), near);
  };
  expect(kSkewed, 2.200985, {1.3333333333333333, 5.645833333333333});
  expect(kEven, 2.144787, {4.153333333333333, 4.7266666666666675});
}

TEST(BootstrapInterval, ShiftsAndScalesWithTheValues) {
  const auto interval = bootstrap_interval(kSkewed);
  std::vector<double> moved;
  for (const double value : kSkewed) moved.push_back(1e9 + 2.0 * value);  // without rounding
  const auto moved_interval = bootstrap_interval(moved);
  ASSERT_TRUE(interval && moved_interval);
  EXPECT_NEAR(moved_interval->low, 1e9 + 2.0 * interval->low, 1e-6);
  EXPECT_NEAR(moved_interval->high, 1e9 + 2.0 * interval->high, 1e-6);
}

TEST(BootstrapInterval, SameSeedSameInterval) {
  const auto first = bootstrap_interval(kSkewed, {.seed = 5});
  const auto again = bootstrap_interval(kSkewed, {.seed = 5});
  const auto other = bootstrap_interval(kSkewed, {.seed = 6});
  ASSERT_TRUE(first && again && other);
  EXPECT_EQ(first->low, again->low);
  EXPECT_EQ(first->high, again->high);
  EXPECT_NE(first->high, other->high);
}

TEST(BootstrapInterval, EqualValuesAndTooFew) {
  const auto equal = bootstrap_interval(std::vector<double>(7, 0.1));
  ASSERT_TRUE(equal);
  EXPECT_EQ(equal->low, 0.1);
  EXPECT_EQ(equal->high, 0.1);
  EXPECT_FALSE(bootstrap_interval(std::vector<double>{1.0}));
  EXPECT_FALSE(bootstrap_interval({}));
}

// Of 8 values a bootstrap without the widening holds it in 89 % of cases.
TEST(BootstrapInterval, HoldsANormalMeanAsOftenAsItSays) {
  RandomStream random(3, "coverage");
  constexpr int kRepeats = 1000;
  int held = 0;
  for (int repeat = 0; repeat < kRepeats; ++repeat) {
    std::vector<double> values(8);
    for (double& value : values) value = 2.0 + 0.5 * random.normal();
    const BootstrapOptions options{.resamples = 1000, .seed = static_cast<std::uint64_t>(repeat)};
    if (bootstrap_interval(values, options)->contains(2.0)) ++held;
  }
  EXPECT_GE(held, static_cast<int>(0.93 * kRepeats));
  EXPECT_LE(held, static_cast<int>(0.97 * kRepeats));
}

TEST(BootstrapInterval, Refuses) {
  for (const double bad : {kNaN, kInfinity}) {
    EXPECT_THAT(input_error_of([&] {
                  bootstrap_interval(std::vector<double>{1.0, bad});
                }),
                HasSubstr("finite values"));
    const std::vector<double> good{1.0, 2.0};
    const std::vector<double> with_bad{1.0, bad};
    EXPECT_THAT(input_error_of([&] { bca_interval(bad, good, good, 0.9); }), HasSubstr("finite"));
    EXPECT_THAT(input_error_of([&] { bca_interval(1, with_bad, good, 0.9); }), HasSubstr("finite"));
    EXPECT_THAT(input_error_of([&] { bca_interval(1, good, with_bad, 0.9); }), HasSubstr("finite"));
  }
  EXPECT_THAT(input_error_of([] { bca_interval(1, {}, kEven, 0.9); }), HasSubstr("1 resample"));
  EXPECT_THAT(input_error_of([] { bca_interval(1, kEven, {}, 0.9); }), HasSubstr("1 jackknife"));
  EXPECT_THAT(input_error_of([] { bootstrap_interval(kEven, {.resamples = 0}); }),
              HasSubstr("at least 1 resample"));
  for (const double probability : {0.0, 1.0, kNaN}) {
    EXPECT_THAT(input_error_of([&] { bootstrap_interval(kEven, {.probability = probability}); }),
                HasSubstr("between 0 and 1"));
    EXPECT_THAT(input_error_of([&] { bca_interval(1, kEven, kEven, probability); }),
                HasSubstr("between 0 and 1"));
  }
}

}  // namespace
}  // namespace fathom
