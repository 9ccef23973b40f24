// Intervals of a mean over cells whose values are independent draws.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/evaluation/clustered.hpp"

namespace fathom {
namespace {

// Two values each: the spread of a mean is that of two values, with two degrees of freedom.
TEST(Stratified, AnIntervalOverCellsKnowsHowFewValuesTheyHave) {
  const std::vector<std::vector<double>> cells{{1.0, 3.0}, {11.0, 13.0}};
  const auto interval = stratified_interval(cells);
  ASSERT_TRUE(interval);
  // Student's: the variance of each mean is 1, so that of theirs 1 / 2; t of 2 degrees is 4.303.
  const double half = 4.303 * std::sqrt(0.5);
  EXPECT_NEAR(interval->low, 7.0 - half, 0.2 * half);
  EXPECT_NEAR(interval->high, 7.0 + half, 0.2 * half);
  EXPECT_FALSE(stratified_interval(std::vector<std::vector<double>>{{1.0, 3.0}, {11.0}}));
}

TEST(Stratified, AnIntervalOverCellsHoldsTheMean) {
  RandomStream random(3, "cells");
  int held = 0;
  constexpr int kStudies = 400;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<std::vector<double>> cells(4, std::vector<double>(3));
    for (auto& cell : cells) {
      for (double& value : cell) value = random.normal();
    }
    held += stratified_interval(cells, {.resamples = 500})->contains(0.0) ? 1 : 0;
  }
  // Of 95 %, less what a bootstrap of three values cannot know; 85 % without the widening.
  EXPECT_GT(held, 0.91 * kStudies);
}

// Of a single cell it is the interval of a sample.
TEST(Stratified, AnIntervalOverOneCellIsThatOfItsValues) {
  const std::vector<double> values{1.0, 1.4, 0.7, 1.1, 1.9, 0.8};
  const auto one = stratified_interval(std::vector<std::vector<double>>{values});
  const auto sample = bootstrap_interval(values);
  EXPECT_NEAR(one->low, sample->low, 0.1 * (sample->high - sample->low));
  EXPECT_NEAR(one->high, sample->high, 0.1 * (sample->high - sample->low));
}

}  // namespace
}  // namespace fathom
