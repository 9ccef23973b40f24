#include "fathom/measurements/variance_components.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include <gtest/gtest.h>

#include "measurements/dense_likelihood.hpp"
#include "measurements/shared_log.hpp"
#include "measurements/tilted_survey.hpp"
#include "measurements/with_sigmas.hpp"

namespace fathom {
namespace {

using test::DenseLikelihood;
using test::kBoth;
using test::kTilt;
using test::SharedWalk;
using test::TiltedSurvey;
using VarianceOutcome = VarianceEstimate::Outcome;

double dense(const MeasurementLog& log, const std::vector<Pose>& poses,
             const std::vector<VarianceComponent>& components, const std::vector<double>& sigmas) {
  return DenseLikelihood(test::with_sigmas(log, components, sigmas), poses).value();
}

void expect_dense(const MeasurementLog& log, const std::vector<Pose>& poses,
                  const std::vector<VarianceComponent>& components) {
  for (const std::vector<double>& both : {std::vector{0.0, 0.0, 0.0},
                                          {1e-4, 0.3, 2.0},
                                          {0.02, 0.0, 0.1},
                                          {0.1, 0.03, 5.0},
                                          {1.0, 10.0, 0.5}}) {
    const std::vector<double> sigmas(both.begin(),
                                     both.begin() + static_cast<std::ptrdiff_t>(components.size()));
    const double expected = dense(log, poses, components, sigmas);
    EXPECT_NEAR(restricted_log_likelihood(log, poses, components, sigmas), expected,
                1e-9 * std::abs(expected));
  }
}

// The walk with a compass, fixes and an uncertain or a free start.
MeasurementLog anchored(const MeasurementLog& walk, const std::vector<Pose>& truth, bool is_free) {
  StartPose start(truth[0]);
  start.covariance = Eigen::Vector3d(0.01, 0.02, 0.003).asDiagonal();
  start.is_free = is_free;
  MeasurementLog log(start);
  for (std::size_t k = 0; k < walk.size(); ++k) {
    if (k > 0) log.add_keyframe(walk.arrival(k).step);
    for (const RelativePose& z : walk.arrival(k).registrations) log.add_registration(z);
    log.add_absolute(AbsolutePose::heading(k, truth[k].theta + 0.01, 0.02));
    if (k % 3 == 0) {
      log.add_absolute(AbsolutePose::position(k, truth[k].position(), 0.01 * rotation(0.0)));
    }
  }
  return log;
}

TEST(RestrictedLikelihood, IsThatOfDenseMatrices) {
  for (const int per_keyframe : {1, 5}) {
    const SharedWalk walk(14, per_keyframe, 3);
    for (const std::vector<Pose>& poses : {walk.truth, walk.log.odometry()}) {
      expect_dense(walk.log, poses, kTilt);
      expect_dense(walk.log, poses, kBoth);
    }
    expect_dense(anchored(walk.log, walk.truth, false), walk.log.odometry(), kBoth);
    expect_dense(anchored(walk.log, walk.truth, true), walk.log.odometry(), kBoth);
  }
  const TiltedSurvey survey({.keyframes = 24, .per_keyframe = 3.0, .tilt_rad = 0.02}, 1);
  expect_dense(survey.log, survey.log.odometry(), kBoth);
}

TEST(RestrictedLikelihood, OfSomePictures) {
  const SharedWalk walk(14, 5, 4);
  std::vector<VarianceComponent> components = kBoth;
  for (std::size_t k = 0; k < walk.log.size(); ++k) {
    components[0].governed.push_back(k % 3 != 0);
    components[1].governed.push_back(k % 4 != 1);
  }
  expect_dense(walk.log, walk.truth, components);
}

// What a registration's own covariance leaves out, alone and with what pictures share.
TEST(RestrictedLikelihood, OfTheRegistrationsOwnErrors) {
  const SharedWalk walk(14, 5, 4);
  const VarianceComponent own{VarianceComponent::Part::own};
  expect_dense(walk.log, walk.truth, {own});
  expect_dense(walk.log, walk.log.odometry(), {kBoth[0], kBoth[1], own});
}

TEST(VarianceComponents, OwnErrorsThatAreToldTooSmallAreFound) {
  // Nine times the own covariance: σ² = 8 of what is told.
  constexpr double kFactor = 3.0;
  int held = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TiltedSurvey survey({.keyframes = 24, .per_keyframe = 3.0, .tilt_rad = 0.02}, seed);
    MeasurementLog log(survey.log.start());
    for (std::size_t k = 1; k < survey.log.size(); ++k) {
      log.add_keyframe(survey.log.arrival(k).step);
      for (RelativePose z : survey.log.arrival(k).registrations) {
        SharedErrors shared = *z.shared;
        shared.own /= kFactor * kFactor;
        z.information =
            RelativePose::from_covariance(z.from, z.to, z.motion, shared.total()).information;
        z.shared = std::make_shared<const SharedErrors>(shared);
        log.add_registration(z);
      }
    }
    const VarianceEstimate found =
        estimate_variance(log, log.odometry(),
                          std::vector{kTilt[0], VarianceComponent{VarianceComponent::Part::own}});
    const double truth = std::sqrt(kFactor * kFactor - 1.0);
    if (found.components[1].low <= truth && truth <= found.components[1].high) ++held;
  }
  // Of 20 at 95 %: fewer than 16 would be chance once in 400 times.
  EXPECT_GE(held, 16);
}

TEST(RestrictedLikelihood, DerivativesAreThoseOfDenseMatrices) {
  const SharedWalk walk(14, 5, 5);
  std::vector<VarianceComponent> components = kBoth;
  components[1].governed.assign(walk.log.size(), true);
  components[1].governed[4] = components[1].governed[7] = false;
  for (const std::vector<double>& sigmas :
       {std::vector{0.001, 0.2}, {0.03, 0.02}, {0.2, 0.004}, {0.7, 5.0}}) {
    Eigen::VectorXd slope;
    restricted_log_likelihood(walk.log, walk.truth, components, sigmas, {}, &slope);
    ASSERT_EQ(slope.size(), 2);
    for (std::size_t j = 0; j < 2; ++j) {
      std::vector<double> above = sigmas;
      std::vector<double> below = sigmas;
      const double step = 1e-4;
      above[j] *= std::exp(step);
      below[j] *= std::exp(-step);
      const double expected = (dense(walk.log, walk.truth, components, above) -
                               dense(walk.log, walk.truth, components, below)) /
                              (2.0 * step);
      EXPECT_NEAR(slope[static_cast<Eigen::Index>(j)], expected, 1e-5 + 1e-6 * std::abs(expected));
    }
  }
}

TEST(VarianceComponents, TheEstimateIsTheHighestOfADenseGrid) {
  const TiltedSurvey survey(
      {.keyframes = 24, .per_keyframe = 3.0, .tilt_rad = 0.02, .altitude_m = 0.01}, 2);
  const VarianceEstimate found = estimate_variance(survey.log, survey.log.odometry(), kBoth);
  ASSERT_EQ(found.outcome, VarianceOutcome::converged);
  const double tilt = found.components[0].sigma;
  const double altitude = found.components[1].sigma;
  const double best = dense(survey.log, found.trajectory, kBoth, {tilt, altitude});
  EXPECT_NEAR(found.log_likelihood, best, 1e-6);
  double highest = -std::numeric_limits<double>::infinity();
  for (double a = -1.0; a <= 1.0; a += 0.2) {
    for (double b = -1.0; b <= 1.0; b += 0.2) {
      highest = std::max(highest, dense(survey.log, found.trajectory, kBoth,
                                        {tilt * std::exp(a), altitude * std::exp(b)}));
    }
  }
  EXPECT_NEAR(highest, best, 1e-6);
}

TEST(VarianceComponents, TheIntervalEndsWhereTheProfileFallsByHalfOfThreePointEight) {
  const TiltedSurvey survey({.keyframes = 24, .per_keyframe = 3.0, .tilt_rad = 0.02}, 3);
  const VarianceEstimate found = estimate_variance(survey.log, survey.log.odometry(), kTilt);
  ASSERT_EQ(found.outcome, VarianceOutcome::converged);
  const SigmaEstimate& tilt = found.components[0];
  EXPECT_LT(tilt.low, tilt.sigma);
  EXPECT_LT(tilt.sigma, tilt.high);
  const auto fall = [&](double sigma) {
    return found.log_likelihood - dense(survey.log, found.trajectory, kTilt, {sigma});
  };
  EXPECT_NEAR(fall(tilt.low), 0.5 * 3.8415, 1e-3);
  EXPECT_NEAR(fall(tilt.high), 0.5 * 3.8415, 1e-3);
  EXPECT_NEAR(2.0 * fall(0.0), tilt.against_zero, 1e-3 * tilt.against_zero);
  EXPECT_NEAR(2.0 * fall(0.005), tilt.against_told, 1e-6 * tilt.against_told);
}

// The σ are the same, and which are bounded.
TEST(VarianceComponents, IntervalsThatAreNotWantedAreLeftOut) {
  const TiltedSurvey survey({.keyframes = 24, .per_keyframe = 3.0, .tilt_rad = 0.02}, 3);
  const VarianceEstimate with = estimate_variance(survey.log, survey.log.odometry(), kBoth);
  std::vector<double> asked;
  VarianceOptions options;
  options.wants_intervals = [&](std::span<const double> sigmas) {
    asked.assign(sigmas.begin(), sigmas.end());
    return false;
  };
  const VarianceEstimate without =
      estimate_variance(survey.log, survey.log.odometry(), kBoth, options);
  ASSERT_EQ(without.components.size(), with.components.size());
  for (std::size_t i = 0; i < with.components.size(); ++i) {
    EXPECT_EQ(without.components[i].sigma, asked[i]);
    if (with.components[i].sigma > 0.0) {
      EXPECT_EQ(without.components[i].sigma, with.components[i].sigma);
    }
    EXPECT_EQ(without.components[i].is_determined(), with.components[i].is_determined());
    EXPECT_TRUE(std::isnan(without.components[i].low));
  }
  options.wants_intervals = [](std::span<const double> /*sigmas*/) { return true; };
  const VarianceEstimate wanted =
      estimate_variance(survey.log, survey.log.odometry(), kBoth, options);
  EXPECT_EQ(wanted.components[0].low, with.components[0].low);
  EXPECT_EQ(wanted.components[0].high, with.components[0].high);
}

TEST(VarianceComponents, AHoleThatAloneTiesTwoPartsSaysNothing) {
  const TiltedSurvey survey({.keyframes = 16, .per_keyframe = 2.0, .tilt_rad = 0.02}, 5);
  const auto with_hole = [&](double sigma) {
    MeasurementLog log;
    for (std::size_t k = 1; k < survey.log.size(); ++k) {
      RelativePose step = survey.log.arrival(k).step;
      if (k == 8) {
        step = RelativePose::from_covariance(7, 8, step.motion,
                                             sigma * sigma * Eigen::Matrix3d::Identity());
        step.is_hole = true;
      }
      log.add_keyframe(step);
      for (const RelativePose& z : survey.log.arrival(k).registrations) {
        if (z.from / 8 == z.to / 8) log.add_registration(z);
      }
    }
    return estimate_variance(log, log.odometry(), kTilt);
  };
  const VarianceEstimate narrow = with_hole(0.1);
  const VarianceEstimate wide = with_hole(3.0);
  ASSERT_EQ(wide.outcome, VarianceOutcome::converged);
  EXPECT_NEAR(narrow.components[0].sigma, wide.components[0].sigma, 1e-6);
  EXPECT_NEAR(narrow.components[0].high, wide.components[0].high, 1e-5);
  EXPECT_NEAR(narrow.degrees_of_freedom, wide.degrees_of_freedom, 0.0);
}

}  // namespace
}  // namespace fathom
