// Of the conformance suite: covariances of poses and motions.

#include "support/planar.hpp"
#include "tests/estimators/conformance.hpp"
#include "tests/estimators/naive_least_squares.hpp"

namespace fathom::test {
namespace {

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
  const NaiveLeastSquares reference = least_squares(log, 1);
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
  const Eigen::MatrixXd expected = least_squares(log, 1).joint(keyframes);
  EXPECT_LT(largest_block_difference(*joint, expected), 1e-9);
  EXPECT_EQ(*joint, joint->transpose());
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const Eigen::Matrix3d own = *estimator->covariance(keyframes[i]);
    EXPECT_LE((joint->block<3, 3>(row, row) - own).norm(), 1e-9 * own.norm()) << keyframes[i];
  }
}

// Exact measurements are linearised at the truth, wherever an estimator linearised last.
TEST_P(Conformance, TheNewestCovarianceOfAnExactLogIsThatOfTheInformationMatrix) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = 20;
  options.origin = {-4.0, 1.0, 2.0};
  const MeasurementLog log = circle_log(options);
  const auto estimator = make(log.origin());
  EXPECT_EQ(*estimator->newest_covariance(), Eigen::Matrix3d::Zero());
  MeasurementLog so_far(log.origin());
  for (std::size_t k = 1; k < log.size(); ++k) {
    so_far.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) so_far.add_registration(z);
    estimator->add_keyframe(log.arrival(k).step);
    if (!log.arrival(k).registrations.empty()) estimator->update({log.arrival(k).registrations});
    const auto covariance = estimator->newest_covariance();
    ASSERT_TRUE(covariance);
    const Eigen::Matrix3d expected = least_squares(so_far, 1).marginal(k);
    EXPECT_LT((*covariance - expected).norm(), 1e-7 * expected.norm()) << "keyframe " << k;
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
Eigen::Matrix3d relative_covariance(const NaiveLeastSquares& reference, std::size_t k) {
  const std::size_t n = reference.poses.size() - 1;
  const Pose& from = reference.poses[k];
  const Pose& to = reference.poses[n];
  const auto motion = [](const Pose& a, const Pose& b) {
    return t2v(homogeneous(a).inverse() * homogeneous(b));
  };
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, reference.covariance.cols());
  const auto put = [&](std::size_t keyframe, const Eigen::Matrix3d& block) {
    if (keyframe > 0) J.middleCols<3>(static_cast<Eigen::Index>(3 * (keyframe - 1))) = block;
  };
  put(k, numerical_jacobian([&](const Pose& a) { return motion(a, to); }, from));
  put(n, numerical_jacobian([&](const Pose& b) { return motion(from, b); }, to));
  return J * reference.covariance * J.transpose();
}

TEST_P(Conformance, MotionsToTheNewestOfAnExactLogAreThoseOfTheInformationMatrix) {
  LogOptions options;
  options.noise = 0.0;
  options.keyframes = 26;  // ends on a loop
  options.origin = {-4.0, 1.0, 2.0};
  const MeasurementLog log = circle_log(options);
  const auto estimator = solved(GetParam(), log);
  const NaiveLeastSquares reference = least_squares(log, 1);
  const auto motions = estimator->motions_to_newest();
  ASSERT_TRUE(motions);
  ASSERT_EQ(motions->size(), log.size() - 1);
  for (std::size_t k = 0; k + 1 < log.size(); ++k) {
    const Pose truth = between(reference.poses[k], reference.poses.back());
    EXPECT_LT(distance((*motions)[k].mean, truth), 1e-9);
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
    EXPECT_LT(distance((*motions)[k].mean, chain.mean), 1e-11);
    EXPECT_LT(((*motions)[k].covariance - chain.covariance).norm(), 1e-9 * chain.covariance.norm());
  }
}

// Keyframe 0 is fixed at the identity, so the motion from it is the pose.
TEST_P(Conformance, TheMotionFromKeyframeZeroIsAsUncertainAsThePose) {
  const auto estimator = solved(GetParam(), circle_log({}));
  const std::size_t newest = estimator->size() - 1;
  const auto motions = estimator->motions_to_newest();
  ASSERT_TRUE(motions);
  EXPECT_LT(distance(motions->front().mean, estimator->pose(newest)), 1e-11);
  const Eigen::Matrix3d expected = *estimator->covariance(newest);
  EXPECT_LT((motions->front().covariance - expected).norm(), 1e-8 * expected.norm());
  EXPECT_TRUE(make()->motions_to_newest()->empty());
}

// What an estimator overrides for speed is what follows from its joint covariances.
TEST_P(Conformance, OverriddenCovariancesAreTheDefaults) {
  LogOptions options;
  options.keyframes = 26;
  options.origin = {-4.0, 1.0, 2.0};
  const auto estimator = solved(GetParam(), circle_log(options));
  const auto motions = estimator->motions_to_newest();
  const auto expected = estimator->Estimator::motions_to_newest();
  ASSERT_TRUE(motions && expected);
  ASSERT_EQ(motions->size(), expected->size());
  for (std::size_t k = 0; k < expected->size(); ++k) {
    const UncertainPose& motion = (*motions)[k];
    EXPECT_LT(distance(motion.mean, (*expected)[k].mean), 1e-10) << k;
    const Eigen::Matrix3d& C = (*expected)[k].covariance;
    EXPECT_LT((motion.covariance - C).norm(), 1e-8 * C.norm()) << k;
    const Eigen::Matrix3d own = *estimator->Estimator::covariance(k);
    EXPECT_LE((*estimator->covariance(k) - own).norm(), 1e-8 * own.norm()) << k;
  }
}

}  // namespace
}  // namespace fathom::test
