#include "src/report/honesty_words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/evaluation/consistency.hpp"

namespace fathom {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

using Figures = std::map<std::string, MetricSummary>;

// With an interval of so much to either side.
MetricSummary figure(double mean, double half_width) {
  MetricSummary summary;
  summary.moments.mean = mean;
  summary.interval = Interval{mean - half_width, mean + half_width};
  return summary;
}

// Ten draws of a log with 100 registrations; all as expected, with an ANEES to be set.
constexpr std::size_t kDraws = 10;
std::vector<std::string> words_of_figures(const Figures& figures, std::size_t draws) {
  EstimatorResults one;
  one.honesty = honesty_of(figures, draws);
  one.consistency = figures;
  return honesty_words(one);
}

Figures honest(double anees) {
  return {{"anees", figure(anees, 0.2)},
          {"mean_nis_truth", figure(3.0, 0.1)},
          {"picture_error_correlation", figure(0.0, 0.02)},
          {"chi2_per_dof", figure(1.0, 0.02)},
          {"registrations", figure(100.0, 2.0)}};
}

TEST(HonestyWords, NothingIsSaidOfWhatIsAsExpected) {
  EXPECT_THAT(words_of_figures({}, kDraws), IsEmpty());
  EXPECT_THAT(words_of_figures(honest(1.0), kDraws), IsEmpty());
  Figures without = honest(4.0);
  without.erase("anees");
  EXPECT_THAT(words_of_figures(without, kDraws), IsEmpty());
  EXPECT_THAT(words_of_figures(honest(4.0), 0), IsEmpty());
}

// χ² of 30 degrees of freedom over 30 ends at 1.566 (97.5 %) and 0.560 (2.5 %).
TEST(HonestyWords, TheThresholdIsThatOfTheDraws) {
  EXPECT_THAT(words_of_figures(honest(1.56), kDraws), IsEmpty());
  EXPECT_THAT(words_of_figures(honest(1.57), kDraws), SizeIs(2));
  EXPECT_THAT(words_of_figures(honest(0.561), kDraws), IsEmpty());
  EXPECT_THAT(words_of_figures(honest(0.559), kDraws), SizeIs(1));
  // Of a single draw errors that are three times too large may be chance.
  EXPECT_THAT(words_of_figures(honest(3.1), 1), IsEmpty());
  EXPECT_THAT(words_of_figures(honest(3.2), 1), SizeIs(2));
}

TEST(HonestyWords, AnIntervalThatHoldsOneIsNoEvidence) {
  Figures wide = honest(4.0);
  wide["anees"] = figure(4.0, 3.1);
  EXPECT_THAT(words_of_figures(wide, kDraws), IsEmpty());
  wide["anees"] = figure(0.4, 0.7);
  EXPECT_THAT(words_of_figures(wide, kDraws), IsEmpty());
  wide["anees"].interval.reset();
  EXPECT_THAT(words_of_figures(wide, kDraws), SizeIs(1));
}

// 9.35 is the 97.5 % quantile of χ² of 3 degrees of freedom, the error of one pose.
TEST(HonestyWords, AnEstimateThatIsNotAtTheOptimum) {
  Figures figures = honest(4.0);
  figures["chi2_per_dof"] = figure(0.5, 0.02);
  figures["chi2_gap"] = figure(12.0, 2.6);
  EXPECT_THAT(
      words_of_figures(figures, kDraws)[1],
      HasSubstr("not at the optimum of the measurements: its F is above it by 12 [9.4, 15]"));
  figures["chi2_gap"] = figure(12.0, 2.7);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], HasSubstr("share errors"));
}

// Of gaps of many sizes the interval of the mean goes below zero.
TEST(HonestyWords, AMedianAboveTheThresholdIsOffTheOptimumToo) {
  const auto is_off = [](double median) {
    Figures figures{{"chi2_gap", figure(1.7e6, 7e6)}};
    figures["chi2_gap"].moments.median = median;
    return is_off_the_optimum(figures);
  };
  EXPECT_TRUE(is_off(9.4));
  EXPECT_FALSE(is_off(9.3));  // a few runs alone
  Figures single{{"chi2_gap", figure(1.7e6, 0.0)}};
  single["chi2_gap"].interval.reset();
  single["chi2_gap"].moments.median = 1.7e6;
  EXPECT_FALSE(is_off_the_optimum(single));
}

// What considers shared errors minimises no F, and is above each without any linearisation: 300
// degrees of freedom explain 900.
TEST(HonestyWords, GainsThatConsiderSharedErrorsAreNotOffTheOptimum) {
  Figures figures = honest(4.0);
  const auto cause = [&figures](bool considers) {
    return honesty_of(figures, kDraws, considers).value().cause;
  };
  figures["chi2_gap"] = figure(700.0, 100.0);
  // The log tells of no shared errors: it is as all others.
  EXPECT_EQ(cause(true), HonestyCause::off_the_optimum);
  figures["estimates_shared_errors"] = figure(0.0, 0.0);
  EXPECT_EQ(cause(false), HonestyCause::off_the_optimum);
  EXPECT_EQ(cause(true), HonestyCause::linearisation);
  figures["chi2_gap"] = figure(1100.0, 100.0);
  EXPECT_EQ(cause(true), HonestyCause::off_the_optimum);
  // In covariances that are too small by two.
  figures["chi2_optimum"] = figure(600.0, 10.0);
  EXPECT_EQ(cause(true), HonestyCause::linearisation);
}

// An optimum with false loops is none to be held to.
TEST(HonestyWords, AnOptimumThatDoesNotFitIsNoCause) {
  Figures figures = honest(4.0);
  figures["chi2_gap"] = figure(1200.0, 260.0);
  figures["chi2_optimum"] = figure(901.0, 20.0);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], Not(HasSubstr("not at the optimum")));
  figures["chi2_optimum"] = figure(899.0, 20.0);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], HasSubstr("not at the optimum"));
}

TEST(HonestyWords, ABadFirstPicture) {
  Figures figures = honest(4.9);
  figures["anchored_anees"] = figure(1.1, 0.2);
  figures["relative_anees_1_keyframes"] = figure(1.2, 0.2);
  figures["chi2_per_dof"] = figure(0.5, 0.02);
  EXPECT_THAT(words_of_figures(figures, kDraws),
              ElementsAre("Overconfident: ANEES is 4.9 [4.7, 5.1], where 1 is expected.",
                          HasSubstr("With other keyframes held it is 1.1 [0.90, 1.3]")));
  // The motions are as wrong as the poses: it is not the first picture alone.
  figures["relative_anees_1_keyframes"] = figure(4.1, 0.2);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], HasSubstr("share errors"));
  figures.erase("relative_anees_1_keyframes");
  figures["anchored_anees"] = figure(4.0, 0.2);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], HasSubstr("share errors"));
}

TEST(HonestyWords, SharedErrors) {
  Figures figures = honest(4.9);
  figures["chi2_per_dof"] = figure(0.5, 0.02);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1],
              AllOf(HasSubstr("(F per degree of freedom 0.50 [0.48, 0.52]);"),
                    Not(HasSubstr("correlation"))));
  figures["picture_error_correlation"] = figure(0.3, 0.05);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1],
              HasSubstr(", and those of one picture have errors with correlation 0.30"));
  figures["chi2_per_dof"] = figure(1.0, 0.02);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1],
              HasSubstr("share errors: those of one picture have errors with correlation 0.30"));
  // Of one draw there is no interval, and a correlation may be chance.
  figures["picture_error_correlation"].interval.reset();
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], Not(HasSubstr("share errors")));
}

TEST(HonestyWords, RegistrationsThatAreWorseThanTheySay) {
  Figures figures = honest(4.9);
  figures["mean_nis_truth"] = figure(9.0, 0.5);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1],
              HasSubstr("mean NIS against truth is 9.0 [8.5, 9.5], where 3 is expected"));
}

TEST(HonestyWords, AnEstimatorOfItsOwn) {
  EXPECT_THAT(words_of_figures(honest(4.9), kDraws)[1],
              HasSubstr("what is too small is the estimator's own"));
}

TEST(HonestyWords, WithoutGroundTruthOfLoopsFSays) {
  Figures figures = honest(4.9);
  figures.erase("mean_nis_truth");
  figures["chi2_per_dof"] = figure(2.0, 0.1);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], HasSubstr("F per degree of freedom is 2.0"));
  figures.erase("chi2_per_dof");
  EXPECT_THAT(words_of_figures(figures, kDraws), SizeIs(1));
}

TEST(HonestyWords, Underconfident) {
  Figures figures = honest(0.2);
  figures["anees"] = figure(0.2, 0.05);
  EXPECT_THAT(words_of_figures(figures, kDraws),
              ElementsAre("Underconfident: ANEES is 0.20 [0.15, 0.25], where 1 is expected."));
  figures["holes"] = figure(2.0, 0.0);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], HasSubstr("no measurement bridges"));
  figures["mean_nis_truth"] = figure(0.5, 0.1);
  EXPECT_THAT(words_of_figures(figures, kDraws)[1], HasSubstr("registrations are too large"));
}

TEST(HonestyWords, KnowsItsMetrics) {
  for (const char* name : {"anees", "anchored_anees", "relative_anees_5_m", "registrations"}) {
    EXPECT_TRUE(is_of_honesty(name)) << name;
  }
  EXPECT_FALSE(is_of_honesty("total_ms"));
}

}  // namespace
}  // namespace fathom
