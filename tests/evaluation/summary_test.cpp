#include "fathom/evaluation/summary.hpp"

#include <cmath>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.hpp"
#include "support/numbers.hpp"

namespace fathom {
namespace {

using test::kInfinity;
using test::kNaN;

TEST(Summary, HandNumbers) {
  const auto five = summarise(std::vector<double>{5, 1, 4, 2, 3});
  ASSERT_TRUE(five);
  EXPECT_EQ(five->count, 5U);
  EXPECT_DOUBLE_EQ(five->mean, 3);
  EXPECT_DOUBLE_EQ(five->median, 3);
  EXPECT_DOUBLE_EQ(five->p95, 4.8);
  EXPECT_DOUBLE_EQ(five->max, 5);
  EXPECT_DOUBLE_EQ(five->total, 15);
  EXPECT_DOUBLE_EQ(summarise(std::vector<double>{1, 2, 3, 10})->median, 2.5);
}

// Python 3.11: statistics.quantiles(v, n=20, method='inclusive')[9] and [18], of the same
// definition.
TEST(Summary, RecordedNumbers) {
  const std::vector<double> values{2.5, -1.0, 7.25, 3.0, 3.0, 11.5, 0.125, 4.0, 9.0, 6.0, 5.5};
  const auto summary = summarise(values);
  EXPECT_DOUBLE_EQ(summary->median, 4.0);
  EXPECT_DOUBLE_EQ(summary->p95, 10.25);
  EXPECT_DOUBLE_EQ(summarise(std::vector<double>{1, 2, 3, 4})->p95, 3.85);
  EXPECT_DOUBLE_EQ(summary->total, 50.875);
}

TEST(Summary, OfOneValue) {
  const auto one = summarise(std::vector<double>{-7.5});
  for (const double value : {one->mean, one->median, one->p95, one->max, one->total}) {
    EXPECT_EQ(value, -7.5);
  }
}

TEST(Summary, NothingOfNothing) {
  EXPECT_FALSE(summarise({}));
}

TEST(Summary, NaNIsNeverDropped) {
  for (const std::size_t at : {0U, 2U, 4U}) {
    std::vector<double> values{5, 1, 4, 2, 3};
    values[at] = kNaN;
    const auto summary = summarise(values);
    ASSERT_TRUE(summary);
    EXPECT_EQ(summary->count, 5U);
    for (const double value :
         {summary->mean, summary->median, summary->p95, summary->max, summary->total}) {
      EXPECT_TRUE(std::isnan(value));
    }
    EXPECT_TRUE(std::isnan(quantile(values, 0.5)));
  }
}

TEST(Summary, InfinityStaysWhereItIs) {
  const auto summary = summarise(std::vector<double>{1, 2, kInfinity});
  EXPECT_EQ(summary->median, 2);
  EXPECT_EQ(summary->max, kInfinity);
  EXPECT_EQ(summary->mean, kInfinity);
  EXPECT_EQ(quantile(std::vector<double>{-kInfinity, 1, kInfinity}, 0.5), 1);
}

TEST(Quantile, EndsAndBetween) {
  const std::vector<double> values{30, 10, 20};
  EXPECT_EQ(quantile(values, 0.0), 10);
  EXPECT_EQ(quantile(values, 1.0), 30);
  EXPECT_DOUBLE_EQ(quantile(values, 0.25), 15);
  EXPECT_DOUBLE_EQ(quantile(values, 0.9), 28);
}

TEST(Quantile, Refuses) {
  const std::vector<double> values{1.0};
  EXPECT_THAT(test::input_error_of([] { quantile({}, 0.5); }), testing::HasSubstr("one value"));
  for (const double probability : {-0.01, 1.01, kNaN}) {
    EXPECT_THAT(test::input_error_of([&] { quantile(values, probability); }),
                testing::HasSubstr("from 0 to 1"));
  }
}

}  // namespace
}  // namespace fathom
