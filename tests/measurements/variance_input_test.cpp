// Variance components of input that says nothing, is false, or does not fit.

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/measurements/shared_file.hpp"
#include "fathom/measurements/variance_components.hpp"
#include "measurements/dense_likelihood.hpp"
#include "measurements/tilted_survey.hpp"
#include "measurements/with_sigmas.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::DenseLikelihood;
using test::input_error_of;
using test::kBoth;
using test::kTilt;
using test::TiltedSurvey;
using testing::HasSubstr;
using VarianceOutcome = VarianceEstimate::Outcome;

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
    EXPECT_EQ(found.outcome, VarianceOutcome::nothing_told);
    ASSERT_EQ(found.components.size(), 2U);
    EXPECT_FALSE(found.components[0].is_determined());
    EXPECT_EQ(found.components[0].pictures, 0U);
  }
  const std::vector<bool> none(survey.log.registration_count(), false);
  const VarianceEstimate found =
      estimate_variance(survey.log, survey.log.odometry(), kTilt, {.used = none});
  EXPECT_EQ(found.outcome, VarianceOutcome::nothing_told);
}

TEST(VarianceComponents, OneLoopHardlyBoundsATilt) {
  const TiltedSurvey survey({.keyframes = 10, .per_keyframe = 0.1, .tilt_rad = 0.005}, 6);
  ASSERT_EQ(survey.log.registration_count(), 1U);
  const VarianceEstimate found = estimate_variance(survey.log, survey.log.odometry(), kTilt);
  EXPECT_EQ(found.outcome, VarianceOutcome::converged);
  EXPECT_EQ(found.registrations, 1U);
  EXPECT_EQ(found.components[0].pictures, 2U);
  EXPECT_EQ(found.components[0].low, 0.0);
  EXPECT_GT(found.components[0].high, 0.02);
}

TEST(VarianceComponents, FailuresAreValues) {
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const TiltedSurvey survey({.keyframes = 12}, 7);
  std::vector<Pose> poses = survey.log.odometry();
  poses[5].x = kNan;
  EXPECT_EQ(estimate_variance(survey.log, poses, kTilt).outcome,
            VarianceOutcome::numerical_failure);
  EXPECT_TRUE(
      std::isnan(restricted_log_likelihood(survey.log, poses, kTilt, std::vector<double>{0.01})));
  for (const auto& spoil : std::vector<std::function<void(SharedErrors&)>>{
           [](SharedErrors& shared) { shared.from.G(0, 1) = kNan; },
           [](SharedErrors& shared) { shared.own(1, 1) = kNan; },
           [](SharedErrors& shared) { shared.own(1, 1) = -1.0; }}) {
    MeasurementLog log = survey.log;
    RelativePose z = log.arrival(log.size() - 1).registrations.at(0);
    SharedErrors shared = *z.shared;
    spoil(shared);
    z.shared = std::make_shared<const SharedErrors>(shared);
    log.add_registration(z);
    EXPECT_EQ(estimate_variance(log, log.odometry(), kTilt).outcome,
              VarianceOutcome::numerical_failure);
  }
  // Headings alone do not say where a free start is.
  MeasurementLog log = survey.log;
  StartPose start;
  start.is_free = true;
  log.set_start(start);
  log.add_absolute(AbsolutePose::heading(log.size() - 1, 0.0, 0.01));
  EXPECT_EQ(estimate_variance(log, log.odometry(), kTilt).outcome,
            VarianceOutcome::numerical_failure);
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
  EXPECT_THAT(error_of(kTilt, {.used = {true}}), HasSubstr("1 marks of used registrations"));
}

// The log with registrations, by number in order of arrival, moved by `shift_m`, or without them.
MeasurementLog with_false(const MeasurementLog& log, const std::vector<std::size_t>& numbers,
                          std::optional<double> shift_m) {
  MeasurementLog changed;
  std::size_t number = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    changed.add_keyframe(log.arrival(k).step);
    for (RelativePose z : log.arrival(k).registrations) {
      const bool is_false = std::ranges::count(numbers, number++) > 0;
      if (is_false && !shift_m) continue;
      if (is_false) z.motion.x += *shift_m;
      changed.add_registration(z);
    }
  }
  return changed;
}

// rᵀ P r falls by what a registration that is left out was off.
TEST(LeftOutRegistration, IsOffByWhatTheMinimumFallsWithoutIt) {
  const TiltedSurvey survey({.keyframes = 16, .per_keyframe = 2.0, .tilt_rad = 0.02}, 10);
  const VarianceEstimate found = estimate_variance(survey.log, survey.log.odometry(), kTilt);
  ASSERT_EQ(found.outcome, VarianceOutcome::converged);
  ASSERT_EQ(found.left_out_chi2.size(), survey.log.registration_count());
  const MeasurementLog log =
      test::with_sigmas(survey.log, kTilt, std::vector<double>{found.components[0].sigma});
  const double all = DenseLikelihood(log, found.trajectory).chi2();
  for (std::size_t i = 0; i < found.left_out_chi2.size(); ++i) {
    const MeasurementLog without = with_false(log, {i}, std::nullopt);
    const double expected = all - DenseLikelihood(without, found.trajectory).chi2();
    EXPECT_NEAR(found.left_out_chi2[i], expected, 1e-6 * all);
  }
}

TEST(LeftOutRegistration, FalseLoopsAreNotTakenForTilt) {
  const TiltedSurvey survey({.per_keyframe = 3.0, .tilt_rad = 0.01}, 11);
  const std::vector<std::size_t> numbers{3, 40, 77};
  const MeasurementLog log = with_false(survey.log, numbers, 0.3);
  const std::vector<Pose> start = survey.log.odometry();
  const VarianceEstimate found = estimate_variance(log, start, kTilt);
  const VarianceEstimate taken = estimate_variance(log, start, kTilt, {.contradiction = 0.0});
  const VarianceEstimate right =
      estimate_variance(with_false(survey.log, numbers, std::nullopt), start, kTilt);
  ASSERT_EQ(found.outcome, VarianceOutcome::converged);
  EXPECT_GT(taken.components[0].low, 0.03);
  EXPECT_GT(taken.chi2, 10.0 * taken.degrees_of_freedom);
  for (std::size_t i = 0; i < found.used.size(); ++i) {
    EXPECT_EQ(found.used[i], std::ranges::count(numbers, i) == 0) << i;
    EXPECT_EQ(std::isnan(found.left_out_chi2[i]), !found.used[i]);
  }
  EXPECT_NEAR(found.components[0].sigma, right.components[0].sigma, 1e-6);
  EXPECT_NEAR(found.components[0].high, right.components[0].high, 1e-5);
  EXPECT_EQ(found.registrations, right.registrations);
}

}  // namespace
}  // namespace fathom
