// Variance components over many surveys, and of input that says nothing.

#include <algorithm>
#include <cmath>
#include <iostream>
#include <limits>
#include <memory>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/measurements/shared_file.hpp"
#include "fathom/measurements/variance_components.hpp"
#include "measurements/tilted_survey.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::TiltedSurvey;
using test::TiltedSurveyOptions;
using testing::HasSubstr;
using Outcome = VarianceEstimate::Outcome;
using Part = VarianceComponent::Part;

const std::vector<VarianceComponent> kTilt{{Part::tilt}};
const std::vector<VarianceComponent> kBoth{{Part::tilt}, {Part::altitude}};

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
    EXPECT_EQ(found.outcome, Outcome::converged);
    for (std::size_t j = 0; j < components.size(); ++j) {
      const bool is_tilt = components[j].part == Part::tilt;
      held[j] += holds(found.components[j], is_tilt ? options.tilt_rad : options.altitude_m);
    }
  }
  return *std::ranges::min_element(held);
}

struct Case {
  double tilt_rad;
  double per_keyframe;
};

const std::vector<Case> kCases{{0.0, 1.5},  {0.0, 6.0},  {0.005, 1.5}, {0.005, 6.0},
                               {0.02, 1.5}, {0.02, 6.0}, {0.05, 1.5},  {0.05, 6.0}};

// Four standard deviations of a binomial count below 95 %.
int least_held(int surveys) {
  return static_cast<int>(0.95 * surveys - 4.0 * std::sqrt(0.95 * 0.05 * surveys));
}

void expect_coverage(int surveys, std::size_t keyframes) {
  for (const Case& of : kCases) {
    const TiltedSurveyOptions options{
        .keyframes = keyframes, .per_keyframe = of.per_keyframe, .tilt_rad = of.tilt_rad};
    const int held = covered(options, kTilt, surveys);
    std::cout << "tilt " << of.tilt_rad << " rad, " << of.per_keyframe
              << " registrations a keyframe: " << held << " of " << surveys << "\n";
    EXPECT_GE(held, least_held(surveys));
  }
}

TEST(VarianceCoverage, IntervalsHoldTheTruthInNinetyFiveOfAHundredSurveys) {
  expect_coverage(50, 24);
}

// Minutes: by hand, --gtest_also_run_disabled_tests.
TEST(VarianceCoverage, DISABLED_OverManySurveys) {
  expect_coverage(2000, 40);
}

TEST(VarianceCoverage, OfTwoComponents) {
  const TiltedSurveyOptions options{
      .keyframes = 24, .per_keyframe = 4.0, .tilt_rad = 0.02, .altitude_m = 0.01};
  EXPECT_GE(covered(options, kBoth, 40), least_held(40));
}

TEST(VarianceComponents, WhereNothingIsToldNothingIsFound) {
  TiltedSurvey survey({.keyframes = 12}, 1);
  MeasurementLog untold;
  MeasurementLog alone;
  MeasurementLog unmoved;
  for (std::size_t k = 1; k < survey.log.size(); ++k) {
    for (MeasurementLog* log : {&untold, &alone, &unmoved}) {
      log->add_keyframe(survey.log.arrival(k).step);
    }
    for (RelativePose z : survey.log.arrival(k).registrations) {
      SharedErrors shared = *z.shared;
      shared.from.G.setZero();
      shared.to.G.setZero();
      z.shared = std::make_shared<const SharedErrors>(shared);
      unmoved.add_registration(z);
      z.shared = nullptr;
      untold.add_registration(z);
    }
  }
  for (const MeasurementLog* log : {&untold, &alone, &unmoved}) {
    const VarianceEstimate found = estimate_variance(*log, log->odometry(), kBoth);
    EXPECT_EQ(found.outcome, Outcome::nothing_told);
    ASSERT_EQ(found.components.size(), 2U);
    EXPECT_FALSE(found.components[0].is_determined());
    EXPECT_EQ(found.components[0].pictures, 0U);
  }
  const std::vector<bool> none(survey.log.registration_count(), false);
  const VarianceEstimate found =
      estimate_variance(survey.log, survey.log.odometry(), kTilt, {.used = none});
  EXPECT_EQ(found.outcome, Outcome::nothing_told);
}

TEST(VarianceComponents, OneLoopHardlyBoundsATilt) {
  const TiltedSurvey survey({.keyframes = 10, .per_keyframe = 0.1, .tilt_rad = 0.005}, 6);
  ASSERT_EQ(survey.log.registration_count(), 1U);
  const VarianceEstimate found = estimate_variance(survey.log, survey.log.odometry(), kTilt);
  EXPECT_EQ(found.outcome, Outcome::converged);
  EXPECT_EQ(found.registrations, 1U);
  EXPECT_EQ(found.components[0].pictures, 2U);
  EXPECT_EQ(found.components[0].low, 0.0);
  EXPECT_GT(found.components[0].high, 0.02);
}

TEST(VarianceComponents, FailuresAreValues) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const TiltedSurvey survey({.keyframes = 12}, 7);
  std::vector<Pose> poses = survey.log.odometry();
  poses[5].x = kNan;
  EXPECT_EQ(estimate_variance(survey.log, poses, kTilt).outcome, Outcome::numerical_failure);
  EXPECT_TRUE(
      std::isnan(restricted_log_likelihood(survey.log, poses, kTilt, std::vector<double>{0.01})));
  // Headings alone do not say where a free start is.
  MeasurementLog log = survey.log;
  StartPose start;
  start.is_free = true;
  log.set_start(start);
  log.add_absolute(AbsolutePose::heading(log.size() - 1, 0.0, 0.01));
  EXPECT_EQ(estimate_variance(log, log.odometry(), kTilt).outcome, Outcome::numerical_failure);
}

TEST(VarianceComponents, WhatDoesNotFitIsRefused) {
  const TiltedSurvey survey({.keyframes = 12}, 8);
  const std::vector<Pose> poses = survey.log.odometry();
  const auto error_of = [&](const std::vector<VarianceComponent>& components,
                            const VarianceOptions& options) {
    return input_error_of([&] { estimate_variance(survey.log, poses, components, options); });
  };
  EXPECT_THAT(error_of({{}, {}}, {}), HasSubstr("two components govern picture 0"));
  EXPECT_THAT(error_of({{.governed = {true}}}, {}), HasSubstr("1 marks of governed pictures"));
  EXPECT_THAT(error_of({{.least = {0.1}}}, {}), HasSubstr("1 least standard deviations"));
  EXPECT_THAT(error_of(kTilt, {.used = {true}}), HasSubstr("1 marks of used registrations"));
}

TEST(VarianceComponents, ALogWithNewSigmasHasNothingElseNew) {
  const TiltedSurvey survey({.tilt_rad = 0.02}, 9);
  const MeasurementLog changed = with_sigmas(survey.log, kTilt, std::vector<double>{0.02});
  for (std::size_t k = 1; k < survey.log.size(); ++k) {
    const KeyframeMeasurements& arrival = changed.arrival(k);
    for (std::size_t i = 0; i < arrival.registrations.size(); ++i) {
      const RelativePose& z = arrival.registrations[i];
      EXPECT_EQ(z.shared->from.sigma, Eigen::Vector3d(0.0, 0.02, 0.02));
      EXPECT_TRUE(z.covariance().isApprox(z.shared->total(), 1e-9));
      EXPECT_GT(z.covariance().trace(),
                survey.log.arrival(k).registrations[i].covariance().trace());
    }
  }
  const std::vector<double> told{0.005, 0.0};
  EXPECT_EQ(text_of(with_sigmas(changed, kBoth, told)), text_of(survey.log));
  EXPECT_EQ(text_of(with_sigmas(survey.log, kBoth, told)), text_of(survey.log));
}

}  // namespace
}  // namespace fathom
