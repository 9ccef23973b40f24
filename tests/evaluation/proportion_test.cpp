#include "fathom/evaluation/proportion.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "support/input_error.hpp"

namespace fathom {
namespace {

// The ends p of Wilson's interval solve (k/n − p)² = z² p (1 − p) / n, z = 1.959964.
TEST(Wilson, EndsSolveTheScoreEquation) {
  for (const auto& [k, n] : {std::pair{0, 5}, {3, 10}, {7, 7}, {250, 1000}}) {
    const Interval interval =
        wilson_interval(static_cast<std::size_t>(k), static_cast<std::size_t>(n));
    for (const double p : {interval.low, interval.high}) {
      const double off = static_cast<double>(k) / n - p;
      EXPECT_NEAR(off * off, 1.959963985 * 1.959963985 * p * (1 - p) / n, 1e-9) << k << " " << n;
    }
    EXPECT_LT(interval.low, interval.high);
  }
}

TEST(Wilson, WithoutTrialsIsAllThereIs) {
  EXPECT_EQ(wilson_interval(0, 0).low, 0.0);
  EXPECT_EQ(wilson_interval(0, 0).high, 1.0);
}

// 3 of 10 by a sum written out: 1 − p is the root of the four first terms.
TEST(ClopperPearson, UpperBoundLeavesFivePerCentBelow) {
  const double p = clopper_pearson_upper(3, 10);
  const double q = 1 - p;
  const double below = std::pow(q, 10) + 10 * p * std::pow(q, 9) + 45 * p * p * std::pow(q, 8) +
                       120 * p * p * p * std::pow(q, 7);
  EXPECT_NEAR(below, 0.05, 1e-9);
  EXPECT_NEAR(clopper_pearson_upper(0, 5000), 1 - std::pow(0.05, 1.0 / 5000), 1e-12);
  EXPECT_NEAR(clopper_pearson_upper(0, 10, 0.975), 1 - std::pow(0.025, 0.1), 1e-12);
  EXPECT_EQ(clopper_pearson_upper(4, 4), 1.0);
  EXPECT_EQ(clopper_pearson_upper(0, 0), 1.0);
}

TEST(Proportions, RefuseWhatIsNone) {
  const auto refused = [](auto call) { return test::input_error_of(call); };
  EXPECT_NE(refused([] { wilson_interval(3, 2); }).find("3 of 2"), std::string::npos);
  EXPECT_NE(refused([] { clopper_pearson_upper(1, 2, 1.0); }).find("probability"),
            std::string::npos);
}

}  // namespace
}  // namespace fathom
