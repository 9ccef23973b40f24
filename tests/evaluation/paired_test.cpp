#include "fathom/evaluation/paired.hpp"

#include <algorithm>
#include <cmath>
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
using testing::DoubleNear;
using testing::HasSubstr;
using testing::Pointwise;

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
