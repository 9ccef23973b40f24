// What every estimator of the registry must do, whatever its method.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "support/planar.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive.hpp"

namespace fathom {
namespace {

using test::circle_log;
using test::feed;
using test::LogOptions;
using test::solved;

class Conformance : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Estimator> make(const Pose& origin = {},
                                  const EstimatorValues& values = {}) const {
    return builtin_estimators().find(GetParam()).create({origin}, values);
  }
};

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
  const std::vector<Pose> truth = test::circle(options.keyframes);
  const auto estimator = make();
  EXPECT_EQ(feed(*estimator, log), Outcome::converged);
  EXPECT_LT(test::largest_distance(poses_of(*estimator), truth), 1e-9);
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
  EXPECT_LT(test::largest_distance(poses_of(*estimator), test::circle(options.keyframes)), 1e-9);
}

// With measurements that agree exactly every linearisation is at the truth, so a filter's
// covariance is that of the least-squares problem, whatever its state: full covariances, rotations,
// loops.
TEST_P(Conformance, CovariancesOfAnExactLogAreThoseOfTheInformationMatrix) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = 20;
  options.origin = {-4.0, 1.0, 2.0};
  const MeasurementLog log = circle_log(options);
  const auto estimator = solved(GetParam(), log);
  const test::NaiveLeastSquares reference = test::least_squares(log, 1);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const auto covariance = estimator->covariance(k);
    ASSERT_TRUE(covariance);
    const Eigen::Matrix3d expected = reference.marginal(k);
    EXPECT_LT((*covariance - expected).norm(), 1e-9 * expected.norm()) << "keyframe " << k;
  }
}

TEST_P(Conformance, JointCovariancesOfAnExactLogAreThoseOfTheInformationMatrix) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = 20;
  options.origin = {-4.0, 1.0, 2.0};
  const MeasurementLog log = circle_log(options);
  const auto estimator = solved(GetParam(), log);
  const std::vector<std::size_t> keyframes{13, 0, 4, 19, 13, 5};
  const auto joint = estimator->joint_covariance(keyframes);
  ASSERT_TRUE(joint);
  const Eigen::MatrixXd expected = test::least_squares(log, 1).joint(keyframes);
  EXPECT_LT(test::largest_block_difference(*joint, expected), 1e-9);
  EXPECT_EQ(*joint, joint->transpose());
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const Eigen::Matrix3d own = *estimator->covariance(keyframes[i]);
    EXPECT_LE((joint->block<3, 3>(row, row) - own).norm(), 1e-9 * own.norm()) << keyframes[i];
  }
}

TEST_P(Conformance, TheJointCovarianceOfKeyframeZeroAloneOrOfNoneIsZero) {
  const auto estimator = make();
  const auto expect_zero = [&](const std::vector<std::size_t>& keyframes) {
    const auto size = static_cast<Eigen::Index>(3 * keyframes.size());
    const auto joint = estimator->joint_covariance(keyframes);
    ASSERT_TRUE(joint);
    EXPECT_EQ(*joint, Eigen::MatrixXd::Zero(size, size));
  };
  expect_zero({0, 0});
  feed(*estimator, circle_log({}));
  expect_zero({0, 0});
  expect_zero({});
}

// The covariance of ⊖X_k ⊕ X_n from the dense joint one, by differences.
Eigen::Matrix3d relative_covariance(const test::NaiveLeastSquares& reference, std::size_t k) {
  const std::size_t n = reference.poses.size() - 1;
  const Pose& from = reference.poses[k];
  const Pose& to = reference.poses[n];
  const auto motion = [](const Pose& a, const Pose& b) {
    return test::t2v(test::homogeneous(a).inverse() * test::homogeneous(b));
  };
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, reference.covariance.cols());
  const auto put = [&](std::size_t keyframe, const Eigen::Matrix3d& block) {
    if (keyframe > 0) J.middleCols<3>(static_cast<Eigen::Index>(3 * (keyframe - 1))) = block;
  };
  put(k, test::numerical_jacobian([&](const Pose& a) { return motion(a, to); }, from));
  put(n, test::numerical_jacobian([&](const Pose& b) { return motion(from, b); }, to));
  return J * reference.covariance * J.transpose();
}

TEST_P(Conformance, MotionsToTheNewestOfAnExactLogAreThoseOfTheInformationMatrix) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = 26;  // ends on a loop
  options.origin = {-4.0, 1.0, 2.0};
  const MeasurementLog log = circle_log(options);
  const auto estimator = solved(GetParam(), log);
  const test::NaiveLeastSquares reference = test::least_squares(log, 1);
  const auto motions = estimator->motions_to_newest();
  ASSERT_TRUE(motions);
  ASSERT_EQ(motions->size(), log.size() - 1);
  for (std::size_t k = 0; k + 1 < log.size(); ++k) {
    const Pose truth = between(reference.poses[k], reference.poses.back());
    EXPECT_LT(test::distance((*motions)[k].mean, truth), 1e-9);
    EXPECT_LT(((*motions)[k].covariance - relative_covariance(reference, k)).norm(), 1e-9) << k;
  }
}

// The other way round, without a reference: of dead reckoning alone they compose the steps.
TEST_P(Conformance, MotionsToTheNewestComposeTheStepsBeforeAnyLoop) {
  LogOptions options;
  options.loop_every = 0;
  const MeasurementLog log = circle_log(options);
  const auto estimator = solved(GetParam(), log);
  const auto motions = estimator->motions_to_newest();
  ASSERT_TRUE(motions);
  UncertainPose chain;
  for (std::size_t k = log.size() - 1; k-- > 0;) {
    const RelativePose& step = log.arrival(k + 1).step;
    chain = compose(UncertainPose{step.motion, step.covariance()}, chain);
    EXPECT_LT(test::distance((*motions)[k].mean, chain.mean), 1e-11);
    EXPECT_LT(((*motions)[k].covariance - chain.covariance).norm(), 1e-9 * chain.covariance.norm());
  }
}

// Keyframe 0 is fixed at the identity, so the motion from it is the pose.
TEST_P(Conformance, TheMotionFromKeyframeZeroIsAsUncertainAsThePose) {
  const auto estimator = solved(GetParam(), circle_log({}));
  const std::size_t newest = estimator->size() - 1;
  const auto motions = estimator->motions_to_newest();
  ASSERT_TRUE(motions);
  EXPECT_LT(test::distance(motions->front().mean, estimator->pose(newest)), 1e-11);
  const Eigen::Matrix3d expected = *estimator->covariance(newest);
  EXPECT_LT((motions->front().covariance - expected).norm(), 1e-8 * expected.norm());
  EXPECT_TRUE(make()->motions_to_newest()->empty());
}

TEST_P(Conformance, ALoopOfZeroLengthIsUsed) {
  MeasurementLog log;
  const Eigen::Matrix3d C = test::full_covariance(0.1, 0.05);
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
  const double optimum = chi2(log, test::least_squares(log, 10).poses);
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

TEST_P(Conformance, TheWayALoopIsWrittenMakesNoDifferenceToFirstOrder) {
  LogOptions options;
  options.noise = 0.01;
  const MeasurementLog log = circle_log(options);
  MeasurementLog backward;
  for (std::size_t k = 1; k < log.size(); ++k) {
    backward.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) {
      const UncertainPose turned = inverse(UncertainPose{z.motion, z.covariance()});
      backward.add_registration(
          RelativePose::from_covariance(z.to, z.from, turned.mean, turned.covariance));
    }
  }
  const auto a = solved(GetParam(), log);
  const auto b = solved(GetParam(), backward);
  // Second order in a noise of 3e-4 m and 2e-4 rad.
  EXPECT_LT(test::largest_distance(poses_of(*a), poses_of(*b)), 1e-6);
}

TEST_P(Conformance, TheGateRefusesAWrongLoopAndSaysSo) {
  LogOptions options;
  MeasurementLog log = circle_log(options);
  const RelativePose last = log.arrival(log.size() - 1).step;
  const std::size_t k = log.size();
  log.add_keyframe(RelativePose::from_covariance(k - 1, k, last.motion, last.covariance()));
  const auto without = solved(GetParam(), log);
  const Pose right = between(without->pose(10), without->pose(k));
  log.add_registration(RelativePose::from_covariance(
      10, k, {right.x + 5.0, right.y - 3.0, wrap_angle(right.theta + 1.0)},
      test::full_covariance(0.01, 0.005)));

  const auto gated = make({}, test::values({{"gate_probability", "0.9999"}}));
  std::vector<LoopDecision> decisions;
  EXPECT_TRUE(is_done(feed(*gated, log, &decisions)));
  ASSERT_EQ(decisions.size(), log.registration_count());
  for (const LoopDecision& decision : decisions) {
    EXPECT_EQ(decision.fate == LoopFate::used, decision.to != k)
        << decision.from << " to " << decision.to;
    ASSERT_TRUE(decision.nis);
  }
  EXPECT_GT(*decisions.back().nis, 100.0);

  // Without the gate the same loop is taken, and ruins the estimate.
  const auto open = make();
  feed(*open, log);
  EXPECT_LT(test::largest_distance(poses_of(*gated), poses_of(*without)), 1e-9);
  EXPECT_GT(test::largest_distance(poses_of(*open), poses_of(*without)), 0.5);
}

TEST_P(Conformance, TheGateKeepsItsShareOfRightLoops) {
  std::size_t accepted = 0;
  std::size_t all = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    // One loop each, over a short way: the innovation is as Gaussian as its noise.
    RandomStream random(seed, "gate");
    MeasurementLog log;
    for (std::size_t k = 1; k <= 5; ++k) {
      log.add_keyframe(RelativePose::from_covariance(
          k - 1, k, test::perturbed({1.0, 0.0, 0.3}, 0.01, 0.005, random),
          Eigen::Vector3d(1e-4, 1e-4, 2.5e-5).asDiagonal()));
    }
    Pose truth;
    for (int k = 0; k < 5; ++k) truth = compose(truth, {1.0, 0.0, 0.3});
    log.add_registration(
        RelativePose::from_covariance(0, 5, test::perturbed(truth, 0.01, 0.005, random),
                                      Eigen::Vector3d(1e-4, 1e-4, 2.5e-5).asDiagonal()));
    const auto estimator = make({}, test::values({{"gate_probability", "0.5"}}));
    std::vector<LoopDecision> decisions;
    feed(*estimator, log, &decisions);
    ++all;
    if (decisions.front().fate == LoopFate::used) ++accepted;
  }
  // Binomial(40, 0.5): outside 10 … 30 once in a thousand.
  EXPECT_GE(accepted, 10U);
  EXPECT_LE(accepted, 30U);
}

TEST_P(Conformance, NaNIsAFailureAndLeavesTheEstimateAsItWas) {
  const MeasurementLog log = circle_log({});
  const auto estimator = make();
  feed(*estimator, log);
  estimator->add_keyframe(RelativePose::from_covariance(log.size() - 1, log.size(), {1.0, 0.0, 0.0},
                                                        test::full_covariance(0.1, 0.1)));
  const std::vector<Pose> before = poses_of(*estimator);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<RelativePose> bad{RelativePose::from_covariance(
      0, log.size(), {nan, 0.0, 0.0}, test::full_covariance(0.1, 0.1))};
  const UpdateReport report = estimator->close_loops(bad);
  EXPECT_EQ(report.outcome, Outcome::numerical_failure);
  ASSERT_EQ(report.loops.size(), 1U);
  EXPECT_EQ(report.loops.front().fate, LoopFate::lost);
  EXPECT_EQ(poses_of(*estimator), before);

  // And it is forgotten: the next update is as good as ever.
  const std::vector<RelativePose> good{RelativePose::from_covariance(
      0, log.size(), between(before.front(), before.back()), test::full_covariance(0.1, 0.1))};
  EXPECT_TRUE(is_done(estimator->close_loops(good).outcome));
}

TEST_P(Conformance, AnUpdateWithoutRegistrationsIsNone) {
  const auto estimator = make();
  estimator->add_keyframe(
      RelativePose::from_covariance(0, 1, {1.0, 0.0, 0.0}, test::full_covariance(0.1, 0.1)));
  const UpdateReport report = estimator->close_loops({});
  EXPECT_EQ(report.outcome, Outcome::converged);
  EXPECT_TRUE(report.loops.empty());
  EXPECT_EQ(estimator->pose(1), (Pose{1.0, 0.0, 0.0}));
}

TEST_P(Conformance, RefusesUnknownOptionsAndValuesOutOfBounds) {
  EXPECT_THROW(make({}, test::values({{"gate", "0.9"}})), InputError);
  EXPECT_THROW(make({}, test::values({{"gate_probability", "1.5"}})), InputError);
  EXPECT_THROW(make({}, test::values({{"max_iterations", "0"}})), InputError);
}

}  // namespace
}  // namespace fathom
