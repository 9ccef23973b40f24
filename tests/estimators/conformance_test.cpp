// What every estimator of the registry must do, whatever its method.

#include "tests/estimators/conformance.hpp"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/estimators/naive_least_squares.hpp"

namespace fathom::test {
namespace {

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) all.push_back(entry.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Every, Conformance, testing::ValuesIn(names()),
                         [](const auto& name) { return name.param; });

TEST_P(Conformance, StartsWithKeyframeZeroAtTheOrigin) {
  const Pose origin{3.0, -2.0, 2.5};
  const auto estimator = make(origin);
  ASSERT_EQ(estimator->size(), 1U);
  EXPECT_EQ(estimator->pose(0), origin);
  ASSERT_TRUE(estimator->covariance(0));
  EXPECT_EQ(*estimator->covariance(0), Eigen::Matrix3d::Zero());
  EXPECT_EQ(estimator->finish().outcome, Outcome::converged);
}

TEST_P(Conformance, DeadReckoningAloneComposesPosesAndCovariances) {
  LogOptions options;
  options.loop_every = 0;
  options.origin = {1.0, 2.0, -3.0};
  const MeasurementLog log = circle_log(options);
  const auto estimator = make(options.origin);
  EXPECT_EQ(feed(*estimator, log), Outcome::converged);
  const std::vector<Pose> odometry = log.odometry();
  UncertainPose chain{options.origin, Eigen::Matrix3d::Zero()};
  for (std::size_t k = 1; k < log.size(); ++k) {
    EXPECT_LT((estimator->pose(k).position() - odometry[k].position()).norm(), 1e-12);
    chain = compose(chain, {log.arrival(k).step.motion, log.arrival(k).step.covariance()});
    ASSERT_TRUE(estimator->covariance(k));
    EXPECT_LT((*estimator->covariance(k) - chain.covariance).norm(),
              1e-9 * chain.covariance.norm());
  }
}

TEST_P(Conformance, AnExactLoopMovesNothingAndSharpensTheEstimate) {
  LogOptions options;
  options.noise = 0.0;
  const MeasurementLog log = circle_log(options);
  const std::vector<Pose> truth = circle(options.keyframes);
  const auto estimator = make();
  EXPECT_EQ(feed(*estimator, log), Outcome::converged);
  EXPECT_LT(largest_distance(poses_of(*estimator), truth), 1e-9);
  options.loop_every = 0;
  const auto reckoned = solved(GetParam(), circle_log(options));
  const std::size_t last = log.size() - 1;
  EXPECT_LT(estimator->covariance(last)->trace(), 0.5 * reckoned->covariance(last)->trace());
}

// What is left of exact measurements is rounding, and a cost that rounding makes larger or smaller
// says nothing of an update.
TEST_P(Conformance, ManyExactLoopsDoNotDiverge) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = 120;
  options.loop_every = 1;
  const MeasurementLog log = circle_log(options);
  ASSERT_GE(log.registration_count(), 80U);
  const auto estimator = make();
  EXPECT_EQ(feed(*estimator, log), Outcome::converged);
  EXPECT_LT(largest_distance(poses_of(*estimator), circle(options.keyframes)), 1e-9);
}

TEST_P(Conformance, ALoopOfZeroLengthIsUsed) {
  MeasurementLog log;
  const Eigen::Matrix3d C = full_covariance(0.1, 0.05);
  // A square that comes back, reckoned a little wrong; the loop says: the same place, the same
  // heading.
  for (std::size_t k = 1; k <= 4; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.05, 0.0, M_PI / 2 - 0.02}, C));
  }
  log.add_registration(RelativePose::from_covariance(0, 4, {}, 1e-4 * C));
  const auto estimator = make();
  EXPECT_TRUE(is_done(feed(*estimator, log)));
  EXPECT_LT(estimator->pose(4).position().norm(), 5e-3);
  EXPECT_LT(std::abs(estimator->pose(4).theta), 5e-3);
}

TEST_P(Conformance, SeveralLoopsAtOnceWithFullCovariancesLowerTheCost) {
  const MeasurementLog log = circle_log({});
  const auto estimator = make();
  EXPECT_TRUE(is_done(feed(*estimator, log)));
  const double optimum = chi2(log, least_squares(log, 10).poses);
  const double reached = chi2(log, poses_of(*estimator));
  EXPECT_LT(reached, 0.01 * chi2(log, log.odometry()));
  EXPECT_GE(reached, optimum * (1.0 - 1e-9));
  EXPECT_LT(reached, 1.3 * optimum);
}

TEST_P(Conformance, ARotatedAndShiftedWorldTurnsTheEstimateAndItsCovariance) {
  LogOptions options;
  const auto plain = solved(GetParam(), circle_log(options));
  const Pose origin{100.0, -50.0, 2.8};
  options.origin = origin;
  const auto turned = solved(GetParam(), circle_log(options));
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  R.topLeftCorner<2, 2>() = rotation(origin.theta);
  for (std::size_t k = 0; k < plain->size(); ++k) {
    const Pose expected = compose(origin, plain->pose(k));
    EXPECT_LT((turned->pose(k).position() - expected.position()).norm(), 1e-7);
    EXPECT_LT(std::abs(wrap_angle(turned->pose(k).theta - expected.theta)), 1e-7);
    const Eigen::Matrix3d C = transport(R, *plain->covariance(k));
    EXPECT_LT((*turned->covariance(k) - C).norm(), 1e-6 * (C.norm() + 1e-9));
  }
}

TEST_P(Conformance, TheSameCallsGiveTheSameBits) {
  const MeasurementLog log = circle_log({});
  const auto a = solved(GetParam(), log);
  const auto b = solved(GetParam(), log);
  EXPECT_EQ(poses_of(*a), poses_of(*b));
  EXPECT_EQ(*a->covariance(log.size() - 1), *b->covariance(log.size() - 1));
}

TEST_P(Conformance, NaNIsAFailureAndLeavesTheEstimateAsItWas) {
  const MeasurementLog log = circle_log({});
  const auto estimator = make();
  feed(*estimator, log);
  estimator->add_keyframe(RelativePose::from_covariance(log.size() - 1, log.size(), {1.0, 0.0, 0.0},
                                                        full_covariance(0.1, 0.1)));
  const std::vector<Pose> before = poses_of(*estimator);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<RelativePose> bad{
      RelativePose::from_covariance(0, log.size(), {nan, 0.0, 0.0}, full_covariance(0.1, 0.1))};
  const UpdateReport report = estimator->update({bad});
  EXPECT_EQ(report.outcome, Outcome::numerical_failure);
  ASSERT_EQ(report.loops.size(), 1U);
  EXPECT_EQ(report.loops.front().fate, LoopFate::lost);
  EXPECT_EQ(poses_of(*estimator), before);

  // And it is forgotten: the next update is as good as ever.
  const std::vector<RelativePose> good{RelativePose::from_covariance(
      0, log.size(), between(before.front(), before.back()), full_covariance(0.1, 0.1))};
  EXPECT_TRUE(is_done(estimator->update({good}).outcome));
}

// One loop ever more precise, between two free keyframes or from the fixed one. Beyond what doubles
// carry an update fails; where it does not, the estimate is as good as ever.
TEST_P(Conformance, InformationBeyondDoublesIsAFailureAndNeverAWrongEstimate) {
  for (const std::size_t from : {std::size_t{0}, std::size_t{7}}) {
    const std::vector<Pose> limit = least_squares(with_precise_loop(from, 1e9), 10).poses;
    Outcome last = Outcome::converged;
    for (int exponent = 10; exponent <= 40; ++exponent) {
      const auto estimator = make();
      last = feed(*estimator, with_precise_loop(from, std::pow(10.0, exponent)));
      if (!is_done(last)) continue;
      EXPECT_LT(largest_distance(poses_of(*estimator), limit), 0.01)
          << "from " << from << ", information 1e" << exponent;
    }
    EXPECT_EQ(last, Outcome::numerical_failure) << "from " << from;
  }
}

TEST_P(Conformance, AnUpdateWithoutRegistrationsIsNone) {
  const auto estimator = make();
  estimator->add_keyframe(
      RelativePose::from_covariance(0, 1, {1.0, 0.0, 0.0}, full_covariance(0.1, 0.1)));
  const UpdateReport report = estimator->update({});
  EXPECT_EQ(report.outcome, Outcome::converged);
  EXPECT_TRUE(report.loops.empty());
  EXPECT_EQ(estimator->pose(1), (Pose{1.0, 0.0, 0.0}));
}

TEST_P(Conformance, RefusesUnknownOptionsAndValuesOutOfBounds) {
  EXPECT_THROW(make({}, values({{"gate", "0.9"}})), InputError);
  EXPECT_THROW(make({}, values({{"gate_probability", "1.5"}})), InputError);
  EXPECT_THROW(make({}, values({{"max_iterations", "0"}})), InputError);
}

}  // namespace
}  // namespace fathom::test
