// Estimators against each other: covariances of poses and of the motions to the newest keyframe.

#include <limits>

#include <gtest/gtest.h>

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

using test::exactly;
using test::LogOptions;
using test::loops_at_the_end;
using test::solved;

// With noise each filter has linearisations of its own; the graphs share the optimum and its
// Hessian.
TEST(CrossEstimator, TheGraphsAgreeOnTheCovariancesOfNoisyMeasurements) {
  const MeasurementLog log = test::circle_log({});
  const auto reference = solved("ceres_pose_graph", log, exactly());
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    if (entry.name.ends_with("ekf")) continue;
    const auto estimator = solved(entry.name, log, exactly());
    for (std::size_t k = 1; k < log.size(); ++k) {
      const Eigen::Matrix3d expected = *reference->covariance(k);
      EXPECT_LT((*estimator->covariance(k) - expected).norm(), 1e-6 * expected.norm())
          << entry.name << " " << k;
    }
  }
}

TEST(CrossEstimator, TheGraphsAgreeOnTheJointCovariancesOfNoisyMeasurements) {
  const MeasurementLog log = test::circle_log({});
  const std::vector<std::size_t> keyframes{log.size() - 1, 3, 0, 17, 8, 3};
  const Eigen::MatrixXd expected = test::least_squares(log, 20).joint(keyframes);
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    if (entry.name.ends_with("ekf")) continue;
    const auto joint = solved(entry.name, log, exactly())->joint_covariance(keyframes);
    ASSERT_TRUE(joint) << entry.name;
    EXPECT_LT(test::largest_block_difference(*joint, expected), 1e-6) << entry.name;
  }
}

TEST(CrossEstimator, TheGraphsHaveNoCovariancesWhereAPoseIsNotFinite) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::string name :
       {"ceres_pose_graph", "sparse_gauss_newton", "incremental_smoother"}) {
    const auto graph = solved(name, test::circle_log({}));
    const std::size_t newest = graph->size();
    graph->add_keyframe(RelativePose::from_covariance(newest - 1, newest, {nan, 0.0, 0.0},
                                                      test::full_covariance(0.1, 0.1)));
    EXPECT_FALSE(graph->covariance(3)) << name;
    EXPECT_FALSE(graph->joint_covariance(std::vector<std::size_t>{3, newest})) << name;
    EXPECT_FALSE(graph->motions_to_newest()) << name;
  }
}

// The Jacobian of the poses of all keyframes but 0 with respect to the motions between them, by the
// chain rule, pose after pose.
Eigen::MatrixXd jacobian_of_poses(const Estimate& estimator) {
  const auto size = static_cast<Eigen::Index>(3 * (estimator.size() - 1));
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(size, size);
  for (Eigen::Index row = 0; row < size; row += 3) {
    const auto k = static_cast<std::size_t>(row / 3);
    Eigen::Matrix3d J_pose;
    Eigen::Matrix3d J_motion;
    compose(estimator.pose(k), between(estimator.pose(k), estimator.pose(k + 1)), &J_pose,
            &J_motion);
    if (row > 0) J.middleRows<3>(row) = J_pose * J.middleRows<3>(row - 3);
    J.block<3, 3>(row, row) = J_motion;
  }
  return J;
}

TEST(CrossEstimator, JointCovariancesOfTheIekfAreThoseOfItsState) {
  LogOptions options;
  options.origin = {30.0, -20.0, 2.0};
  const MeasurementLog log = test::circle_log(options);
  const std::vector<std::size_t> keyframes{log.size() - 1, 3, 0, 17, 8, 3};
  using Form = MotionCovariance::Form;
  for (const Form form : {Form::cheapest, Form::dense, Form::few_loops}) {
    TrajectoryIekf iekf({log.origin()}, {}, form);
    test::feed(iekf, log);
    const Eigen::MatrixXd J = jacobian_of_poses(iekf);
    const test::NaiveLeastSquares state{{}, J * iekf.state_covariance().full() * J.transpose()};
    EXPECT_LT(
        test::largest_block_difference(*iekf.joint_covariance(keyframes), state.joint(keyframes)),
        1e-10);
  }
}

// With noise the linearisation of the filter is one of its own; its motions are J P Jᵀ of it.
TEST(CrossEstimator, MotionsToTheNewestOfTheIekfAreThoseOfItsState) {
  const MeasurementLog log = test::circle_log({});
  TrajectoryIekf iekf({log.origin()}, {});
  test::feed(iekf, log);
  const std::size_t n = log.size() - 1;
  const Eigen::MatrixXd P = iekf.state_covariance().full();
  const auto motions = iekf.motions_to_newest();
  for (const std::size_t k : {std::size_t{0}, std::size_t{7}, n - 3, n - 1}) {
    // ∂r/∂x_i by the chain rule, motion after motion.
    Pose r;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, P.cols());
    for (std::size_t i = k; i < n; ++i) {
      Eigen::Matrix3d J_r;
      Eigen::Matrix3d J_motion;
      r = compose(r, between(iekf.pose(i), iekf.pose(i + 1)), &J_r, &J_motion);
      J = (J_r * J).eval();
      J.middleCols<3>(static_cast<Eigen::Index>(3 * i)) = J_motion;
    }
    const Eigen::Matrix3d expected = J * P * J.transpose();
    EXPECT_LT(((*motions)[k].covariance - expected).norm(), 1e-10 * expected.norm()) << k;
  }
}

// One update with little noise: the same optimum, and, to first order, the same uncertainty. (With
// more the plain EKF, linearised at dead reckoning, is off by far for the motions that loops fix.)
TEST(CrossEstimator, EstimatorsAgreeOnMotionsToTheNewest) {
  const MeasurementLog log = loops_at_the_end(0.001);
  const auto reference = *solved("ceres_pose_graph", log, exactly())->motions_to_newest();
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const auto motions = *solved(entry.name, log, exactly())->motions_to_newest();
    for (std::size_t k = 0; k < motions.size(); ++k) {
      const Eigen::Matrix3d expected = reference[k].covariance;
      EXPECT_LT((motions[k].covariance - expected).norm(), 0.02 * expected.norm())
          << entry.name << " " << k;
    }
  }
}

// A robust loss weighs the loops; the Hessian behind the motions is that behind the covariances.
TEST(CrossEstimator, MotionsToTheNewestCountTheLossAsTheCovariancesDo) {
  const MeasurementLog log = loops_at_the_end(4.0);
  const auto plain = solved("ceres_pose_graph", log);
  const auto robust =
      solved("ceres_pose_graph", log, test::values({{"loss", "huber"}, {"loss_scale", "0.05"}}));
  const auto of_last = [&](Estimate& estimator) { return *estimator.covariance(log.size() - 1); };
  const Eigen::Matrix3d motion = robust->motions_to_newest()->front().covariance;
  EXPECT_LT((motion - of_last(*robust)).norm(), 1e-8 * motion.norm());
  EXPECT_GT((motion - of_last(*plain)).norm(), 1e-2 * motion.norm());
}

}  // namespace
}  // namespace fathom
