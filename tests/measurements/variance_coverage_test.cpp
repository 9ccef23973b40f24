// How often the intervals of variance components hold the truth.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/measurements/variance_components.hpp"
#include "measurements/tilted_survey.hpp"

namespace fathom {
namespace {

using test::kBoth;
using test::kTilt;
using test::TiltedSurvey;
using test::TiltedSurveyOptions;
using VarianceOutcome = VarianceEstimate::Outcome;
using Part = VarianceComponent::Part;

bool holds(const SigmaEstimate& estimate, double sigma) {
  return estimate.low <= sigma && sigma <= estimate.high;
}

// Surveys of which the intervals of all components hold the truth.
int covered(const TiltedSurveyOptions& options, const std::vector<VarianceComponent>& components,
            int surveys) {
  std::vector<int> held(components.size());
  for (int i = 0; i < surveys; ++i) {
    const TiltedSurvey survey(options, static_cast<std::uint64_t>(i));
    const VarianceEstimate found = estimate_variance(survey.log, survey.log.odometry(), components);
    EXPECT_EQ(found.outcome, VarianceOutcome::converged);
    for (std::size_t j = 0; j < components.size(); ++j) {
      const bool is_tilt = components[j].part == Part::tilt;
      held[j] += holds(found.components[j], is_tilt ? options.tilt_rad : options.altitude_m);
    }
  }
  return *std::ranges::min_element(held);
}

struct DrawnSurvey {
  double tilt_rad;
  double per_keyframe;
};

const std::vector<DrawnSurvey> kDrawn{{0.0, 1.5},  {0.0, 6.0},  {0.005, 1.5}, {0.005, 6.0},
                                      {0.02, 1.5}, {0.02, 6.0}, {0.05, 1.5},  {0.05, 6.0}};

// Four standard deviations of a binomial count below 95 %.
int least_held(int surveys) {
  return static_cast<int>(0.95 * surveys - 4.0 * std::sqrt(0.95 * 0.05 * surveys));
}

void expect_coverage(int surveys, std::size_t keyframes) {
  for (const DrawnSurvey& of : kDrawn) {
    const TiltedSurveyOptions options{
        .keyframes = keyframes, .per_keyframe = of.per_keyframe, .tilt_rad = of.tilt_rad};
    const int held = covered(options, kTilt, surveys);
    std::cout << "tilt " << of.tilt_rad << " rad, " << of.per_keyframe
              << " registrations a keyframe: " << held << " of " << surveys << std::endl;
    EXPECT_GE(held, least_held(surveys));
  }
}

TEST(VarianceCoverage, IntervalsHoldTheTruthInNinetyFiveOfAHundredSurveys) {
  expect_coverage(40, 24);
}

// Minutes: by hand, --gtest_also_run_disabled_tests.
TEST(VarianceCoverage, DISABLED_OverManySurveys) {
  expect_coverage(1000, 40);
}

TEST(VarianceCoverage, OfTwoComponents) {
  const TiltedSurveyOptions options{
      .keyframes = 24, .per_keyframe = 4.0, .tilt_rad = 0.02, .altitude_m = 0.01};
  EXPECT_GE(covered(options, kBoth, 30), least_held(30));
}

}  // namespace
}  // namespace fathom
