// Values of surveys and their trials: means, and intervals that count the surveys.

#include "fathom/evaluation/clustered.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/evaluation/paired.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Normal values of mean 0, with a part that the trials of a survey share.
ClusteredValues drawn(std::size_t surveys, std::size_t trials, double between, double within,
                      RandomStream& random) {
  ClusteredValues values;
  for (std::size_t s = 0; s < surveys; ++s) {
    const double shared = between * random.normal();
    for (std::size_t t = 0; t < trials; ++t) {
      values[s].push_back(shared + within * random.normal());
    }
  }
  return values;
}

std::vector<double> all_of(const ClusteredValues& values) {
  std::vector<double> all;
  for (const auto& [survey, own] : values) all.insert(all.end(), own.begin(), own.end());
  return all;
}

bool holds(const std::optional<Interval>& interval, double value) {
  return interval && interval->low <= value && value <= interval->high;
}

double half_width(const std::optional<Interval>& interval) {
  return 0.5 * (interval->high - interval->low);
}

void expect_same(const std::optional<Interval>& a, const std::optional<Interval>& b) {
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->low, b->low);
  EXPECT_EQ(a->high, b->high);
}

TEST(ClusteredMean, CountsEverySurveyOnce) {
  EXPECT_EQ(clustered_mean({{0, {1.0, 2.0, 3.0}}, {4, {10.0}}}), 6.0);
  EXPECT_THAT(survey_means({{0, {1.0, 2.0, 3.0}}, {4, {10.0}}}), ElementsAre(2.0, 10.0));
  EXPECT_EQ(clustered_mean({{3, {0.1, 0.1, 0.1}}}), 0.1);
}

TEST(HierarchicalInterval, OfOneSurveyIsTheBootstrapOfItsTrials) {
  const std::vector<double> trials{0.3, 0.1, 0.45, 0.2, 0.9};
  expect_same(hierarchical_interval({{2, trials}}), bootstrap_interval(trials));
}

// Of symmetric values it is Student's interval: 2.7764 of t with 4 degrees of freedom.
TEST(HierarchicalInterval, OfOneTrialASurveyIsStudents) {
  const auto interval = hierarchical_interval(
      {{0, {-2.0}}, {1, {-1.0}}, {2, {0.0}}, {3, {1.0}}, {7, {2.0}}}, {0.95, 200'000, 1});
  const double student = 2.7764 * std::sqrt(2.5 / 5.0);
  ASSERT_TRUE(interval);
  EXPECT_NEAR(interval->high, student, 0.04 * student);
  EXPECT_NEAR(interval->low, -student, 0.04 * student);
}

TEST(HierarchicalInterval, OfFewerThanTwoValuesIsNothing) {
  EXPECT_FALSE(hierarchical_interval(ClusteredValues{}));
  EXPECT_FALSE(hierarchical_interval({{0, {1.0}}}));
}

TEST(HierarchicalInterval, OfEqualValuesHasNoWidth) {
  const auto interval = hierarchical_interval({{0, {0.1, 0.1, 0.1}}, {1, {0.1, 0.1}}});
  ASSERT_TRUE(interval);
  EXPECT_EQ(interval->low, 0.1);
  EXPECT_EQ(interval->high, 0.1);
}

// σ of the mean in closed form: of the surveys' means over their number, and no less than that of
// the trials within them.
TEST(HierarchicalInterval, HasTheWidthOfTheSurveysMeans) {
  constexpr std::size_t kSurveys = 200;
  ClusteredValues between;
  ClusteredValues within;
  ClusteredValues both;
  RandomStream random(3);
  for (std::size_t s = 0; s < kSurveys; ++s) {
    const double survey = s % 2 == 0 ? 1.0 : -1.0;
    between[s] = {survey, survey, survey, survey};
    within[s] = {1.0, -1.0, 1.0, -1.0};
    both[s] = {survey + 1.0, survey - 1.0, survey + 1.0, survey - 1.0};
  }
  const double root = std::sqrt(static_cast<double>(kSurveys));
  const BootstrapOptions options{0.95, 20'000, 1};
  EXPECT_NEAR(half_width(hierarchical_interval(between, options)), 1.96 / root, 0.04 / root);
  EXPECT_NEAR(half_width(hierarchical_interval(within, options)), 1.96 * 0.5 / root, 0.03 / root);
  // A bootstrap that resampled at both levels without more ado would have √(1 + 1/4) times this.
  EXPECT_NEAR(half_width(hierarchical_interval(both, options)), 1.96 / root, 0.04 / root);
}

struct Coverage {
  double clustered = 0.0;
  double naive = 0.0;  ///< of the bootstrap over all runs as though they were independent
};

Coverage coverage_of(std::size_t surveys, std::size_t trials, double between, double within) {
  constexpr int kStudies = 1000;
  RandomStream random(11);
  Coverage share;
  for (int study = 0; study < kStudies; ++study) {
    const ClusteredValues values = drawn(surveys, trials, between, within, random);
    const BootstrapOptions options{0.95, 400, static_cast<std::uint64_t>(study)};
    share.clustered += holds(hierarchical_interval(values, options), 0.0) ? 1.0 : 0.0;
    share.naive += holds(bootstrap_interval(all_of(values), options), 0.0) ? 1.0 : 0.0;
  }
  share.clustered /= kStudies;
  share.naive /= kStudies;
  return share;
}

TEST(HierarchicalInterval, CoversTheMeanWhereSurveysDiffer) {
  for (const std::size_t surveys : {4, 10}) {
    const Coverage share = coverage_of(surveys, 10, 1.0, 0.5);
    EXPECT_NEAR(share.clustered, 0.95, 0.03) << surveys;
    // Normal theory of ten: P(|Z| ≤ 1.96 √(1.25 / 100) / √(1/10 + 0.25/100)) = 0.51.
    EXPECT_LT(share.naive, 0.6) << surveys;
  }
}

TEST(HierarchicalInterval, CoversTheMeanWhereSurveysAreAlike) {
  const Coverage share = coverage_of(10, 10, 0.0, 1.0);
  EXPECT_GT(share.clustered, 0.94);
}

TEST(HierarchicalInterval, CoversTheMeanOfSurveysWithUnequalTrials) {
  constexpr int kStudies = 1000;
  RandomStream random(5);
  int held = 0;
  for (int study = 0; study < kStudies; ++study) {
    ClusteredValues values = drawn(20, 8, 0.7, 1.0, random);
    for (auto& [survey, own] : values) own.resize(1 + (survey % 8));
    held += holds(hierarchical_interval(values, {0.95, 400, 1}), 0.0) ? 1 : 0;
  }
  EXPECT_GT(held, 925);
  EXPECT_LT(held, 985);
}

// The same survey stands behind all cells: four cells are no four times as many draws.
TEST(HierarchicalInterval, DrawsSurveysTogetherInAllCells) {
  constexpr int kStudies = 600;
  RandomStream random(8);
  int held = 0;
  int held_apart = 0;
  for (int study = 0; study < kStudies; ++study) {
    std::vector<ClusteredValues> cells(4);
    ClusteredValues apart;
    for (std::size_t s = 0; s < 12; ++s) {
      const double shared = random.normal();
      for (std::size_t c = 0; c < cells.size(); ++c) {
        for (int t = 0; t < 3; ++t) cells[c][s].push_back(shared + 0.5 * random.normal());
        apart[12 * c + s] = cells[c][s];
      }
    }
    held += holds(interval_over_cells(cells, {0.95, 300, 1}), 0.0) ? 1 : 0;
    held_apart += holds(hierarchical_interval(apart, {0.95, 300, 1}), 0.0) ? 1 : 0;
  }
  EXPECT_GT(held, 0.92 * kStudies);
  EXPECT_LT(held, 0.98 * kStudies);
  EXPECT_LT(held_apart, 0.75 * kStudies);
}

TEST(HierarchicalInterval, OfCellsOfWhichOneHasASingleSurveyIsNothing) {
  const std::vector<ClusteredValues> cells{{{0, {1.0, 2.0}}, {1, {2.0, 3.0}}}, {{0, {1.0, 2.0}}}};
  EXPECT_FALSE(interval_over_cells(cells));
}

TEST(HierarchicalInterval, RefusesWhatIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(input_error_of([&] {
                hierarchical_interval({{0, {1.0, nan}}, {1, {1.0, 2.0}}});
              }),
              HasSubstr("needs finite values"));
  EXPECT_THAT(input_error_of([&] {
                hierarchical_interval({{0, {1.0, 2.0}}, {1, {1.0, 2.0}}}, {1.5, 10, 1});
              }),
              HasSubstr("between 0 and 1"));
}

TEST(DifferenceOverSurveys, OfOneSurveyIsOverItsTrials) {
  const std::vector<double> differences{0.1, -0.2, 0.4, 0.3, 0.25, 0.5};
  const auto one = difference_over_surveys({{3, differences}});
  const auto list = paired_difference(differences, std::vector<double>(6, 0.0));
  ASSERT_TRUE(one && list);
  EXPECT_EQ(one->count, 6u);
  EXPECT_EQ(one->trials, 6u);
  EXPECT_FALSE(one->is_over_surveys);
  EXPECT_EQ(one->mean, list->mean);
  EXPECT_EQ(one->signed_rank.p_value, list->signed_rank.p_value);
  expect_same(one->interval, list->interval);
}

TEST(DifferenceOverSurveys, OfSeveralIsOverTheirMeans) {
  const auto result = difference_over_surveys(
      {{0, {0.1, 0.3}}, {1, {0.4}}, {2, {-0.2, 0.0, 0.2}}, {5, {0.6, 0.8}}});
  const std::vector<double> means{0.2, 0.4, 0.0, 0.7};
  const auto list = paired_difference(means, std::vector<double>(4, 0.0));
  ASSERT_TRUE(result && list);
  EXPECT_EQ(result->count, 4u);
  EXPECT_EQ(result->trials, 8u);
  EXPECT_TRUE(result->is_over_surveys);
  EXPECT_NEAR(result->mean, 1.3 / 4.0, 1e-15);
  EXPECT_EQ(result->signed_rank.p_value, list->signed_rank.p_value);
  EXPECT_LT(result->interval->low, list->interval->low);
  EXPECT_FALSE(difference_over_surveys({}));
}

// Two methods that are equal over all floors, but not on each of them.
TEST(DifferenceOverSurveys, FindsNoDifferenceThatOtherSurveysWouldNotShow) {
  constexpr int kStudies = 400;
  RandomStream random(21);
  int found = 0;
  int found_over_trials = 0;
  for (int study = 0; study < kStudies; ++study) {
    const ClusteredValues differences = drawn(8, 10, 1.0, 0.5, random);
    const auto is_found = [](const std::optional<PairedDifference>& result) {
      return *result->signed_rank.p_value <= 0.05 ? 1 : 0;
    };
    const std::vector<double> all = all_of(differences);
    found += is_found(difference_over_surveys(differences, {0.95, 1, 1}));
    found_over_trials +=
        is_found(paired_difference(all, std::vector<double>(all.size(), 0.0), {0.95, 1, 1}));
  }
  EXPECT_LT(found, 0.08 * kStudies);
  EXPECT_GT(found_over_trials, 0.3 * kStudies);
}

}  // namespace
}  // namespace fathom
