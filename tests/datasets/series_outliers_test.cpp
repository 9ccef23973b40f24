#include "fathom/datasets/series_outliers.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

using Values = std::vector<double>;

constexpr double kAllowed = 0.36;

std::vector<std::int64_t> seconds(std::size_t count) {
  std::vector<std::int64_t> times_ns;
  for (std::size_t i = 0; i < count; ++i) {
    times_ns.push_back(static_cast<std::int64_t>(i) * 1'000'000'000);
  }
  return times_ns;
}

std::vector<std::size_t> left_out(const Values& values, double allowed = kAllowed) {
  const std::vector<bool> kept = kept_values(seconds(values.size()), values, allowed);
  EXPECT_EQ(kept.size(), values.size());
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < kept.size(); ++i) {
    if (!kept[i]) indices.push_back(i);
  }
  return indices;
}

Values noise(std::size_t count, double sigma, unsigned seed) {
  std::mt19937 engine(seed);
  std::normal_distribution<double> normal(0.0, sigma);
  Values values(count);
  for (double& value : values) value = normal(engine);
  return values;
}

TEST(SeriesOutliers, SingleReadingsAndRunsOfThreeAndFour) {
  EXPECT_THAT(left_out({0, 0, 0, 1, 0, 0, 0}), ElementsAre(3));
  EXPECT_THAT(left_out({0, 0, 0, 1, 1, 1, 0, 0, 0}), ElementsAre(3, 4, 5));
  EXPECT_THAT(left_out({0, 0, 0, 1, -2, 3, 1, 0, 0, 0, 0, 0}), ElementsAre(3, 4, 5, 6));
  EXPECT_THAT(left_out({5, 0, 0, 0, 0, 0, -5}), ElementsAre(0, 6));
}

TEST(SeriesOutliers, WhatStaysIsNone) {
  EXPECT_THAT(left_out({0, 0, 0, 0, 0, 0, 0}), IsEmpty());
  EXPECT_THAT(left_out({0, 0, 0, 0, 2, 2, 2, 2, 2}), IsEmpty());            // a step
  EXPECT_THAT(left_out({0, 0, 0, 2, 2, 2, 2, 2, 0, 0, 0}), IsEmpty());      // there and back
  EXPECT_THAT(left_out({0, 0, 0, 0, 0, 0, 2, 2}), IsEmpty());               // at the end
  EXPECT_THAT(left_out({0, 0, 0.3, 0.6, 0.9, 1.2, 1.2, 1.2}), IsEmpty());   // a ramp
  EXPECT_THAT(left_out({0, 1, 2, 3, 4, 5, 6, 7}), IsEmpty());               // a steep one
  EXPECT_THAT(left_out({0, 0.2, -0.1, 0, -0.2, 0.1, 0, 0.15}), IsEmpty());  // relief
}

TEST(SeriesOutliers, FewReadingsDoNotTell) {
  EXPECT_THAT(left_out({}), IsEmpty());
  EXPECT_THAT(left_out({1}), IsEmpty());
  EXPECT_THAT(left_out({0, 9}), IsEmpty());
  EXPECT_THAT(left_out({0, 9, 0, 0}), IsEmpty());
}

// Ten in a hundred are off by half or more, alone or in runs as chance has it.
TEST(SeriesOutliers, SpikesOfAnySizeAndTheyAlone) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    Values values = noise(300, 0.005, seed);
    std::mt19937 engine(seed);
    std::vector<std::size_t> spikes;
    for (std::size_t i = 2; i + 2 < values.size(); ++i) {
      if (engine() % 10 != 0) continue;
      const double size = std::log(std::pow(25.0, static_cast<double>(engine() % 1000) / 1000.0));
      values[i] +=
          engine() % 2 == 0 ? std::max(std::log(1.5), size) : -std::max(std::log(2.0), size);
      spikes.push_back(i);
    }
    EXPECT_EQ(left_out(values), spikes) << seed;
  }
}

TEST(SeriesOutliers, OfGaussianNoiseNothing) {
  EXPECT_THAT(left_out(noise(1'000'000, 1.0, 7), 0.0), IsEmpty());
}

// Of Student's t with three degrees of freedom.
TEST(SeriesOutliers, OfHeavyTailsWhatIsFarOut) {
  std::mt19937 engine(11);
  std::student_t_distribution<double> heavy(3.0);
  Values values(1'000'000);
  for (double& value : values) value = heavy(engine);
  const std::vector<std::size_t> indices = left_out(values, 0.0);
  EXPECT_GT(indices.size(), 2000U);
  EXPECT_LT(indices.size(), 4000U);
  const auto far_out =
      std::ranges::count_if(indices, [&](std::size_t i) { return std::abs(values[i]) > 5.0; });
  EXPECT_GT(static_cast<double>(far_out), 0.99 * static_cast<double>(indices.size()));
}

// A minute without readings leads further than a second does.
TEST(SeriesOutliers, TimeBetweenReadingsCounts) {
  std::vector<std::int64_t> times_ns = seconds(12);
  Values values{0, 0.1, 0.2, 0.3, 0.4, 0.5, 6.5, 6.6, 0.8, 0.9, 1.0, 1.1};
  EXPECT_THAT(left_out(values), ElementsAre(6, 7));
  for (std::size_t i = 6; i < 12; ++i) times_ns[i] += 60'000'000'000;
  for (std::size_t i = 8; i < 12; ++i) values[i] += 6.0;
  EXPECT_EQ(kept_values(times_ns, values, kAllowed), std::vector<bool>(12, true));
}

}  // namespace
}  // namespace fathom
