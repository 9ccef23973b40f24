// Estimators against each other: what the framework exists for.

#include <limits>

#include <gtest/gtest.h>

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive.hpp"

namespace fathom {
namespace {

using test::largest_distance;
using test::largest_turn;
using test::LogOptions;
using test::solved;

EstimatorValues exactly() {
  return test::values({{"tolerance", "1e-13"}, {"max_iterations", "100"}});
}

// With headings known to be zero the problem is linear, and everybody must find the same answer.
TEST(CrossEstimator, AllAgreeOnALinearProblem) {
  RandomStream random(5, "linear");
  const auto measured = [&](double x, double y, double sigma_m) {
    return Pose{x + sigma_m * random.normal(), y + sigma_m * random.normal(), 0.0};
  };
  const auto covariance = [](double sigma_m) -> Eigen::Matrix3d {
    Eigen::Matrix3d C = Eigen::Matrix3d::Zero();
    C.topLeftCorner<2, 2>() << 1.0, 0.4, 0.4, 2.0;
    C *= sigma_m * sigma_m;
    C(2, 2) = 1e-16;
    return C;
  };
  MeasurementLog log;
  for (std::size_t k = 1; k <= 30; ++k) {
    log.add_keyframe(
        RelativePose::from_covariance(k - 1, k, measured(1.0, 0.0, 0.1), covariance(0.1)));
    if (k % 4 != 0) continue;
    for (const std::size_t from : {k - 4, k / 2}) {
      log.add_registration(RelativePose::from_covariance(
          from, k, measured(static_cast<double>(k - from), 0.0, 0.02), covariance(0.02)));
    }
  }
  const std::vector<Pose> reference = test::least_squares(log, 2).poses;
  EXPECT_GT(largest_distance(reference, log.odometry()), 0.1);
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    const auto estimator = solved(entry.name, log, exactly());
    EXPECT_LT(largest_distance(poses_of(*estimator), reference), 1e-9) << entry.name;
    EXPECT_LT(largest_turn(poses_of(*estimator), reference), 1e-9) << entry.name;
  }
}

MeasurementLog loops_at_the_end(double noise) {
  LogOptions options;
  options.loops_at_end_only = true;
  options.noise = noise;
  return test::circle_log(options);
}

// With one update the iterated filter solves the same least-squares problem as the graph; the
// plain EKF stops after one step.
TEST(CrossEstimator, IekfAndGraphShareTheOptimumOfASingleUpdateAndTheEkfDoesNot) {
  const MeasurementLog log = loops_at_the_end(4.0);
  const auto iekf = solved("trajectory_iekf", log, exactly());
  const auto graph = solved("ceres_pose_graph", log, exactly());
  const auto ekf = solved("ekf", log);
  EXPECT_LT(largest_distance(poses_of(*iekf), poses_of(*graph)), 1e-6);
  EXPECT_LT(largest_turn(poses_of(*iekf), poses_of(*graph)), 1e-6);
  EXPECT_GT(largest_distance(poses_of(*ekf), poses_of(*graph)), 1e-2);
  EXPECT_GT(chi2(log, poses_of(*ekf)), 1.01 * chi2(log, poses_of(*graph)));
}

TEST(CrossEstimator, SafeguardedIekfSharesTheOptimumToo) {
  const MeasurementLog log = loops_at_the_end(4.0);
  EstimatorValues options = exactly();
  options["safeguard"] = OptionValue::scalar("true");
  const auto iekf = solved("trajectory_iekf", log, options);
  const auto graph = solved("ceres_pose_graph", log, exactly());
  EXPECT_LT(largest_distance(poses_of(*iekf), poses_of(*graph)), 1e-6);
}

TEST(CrossEstimator, TheGraphsFindTheOptimumOfTheTextbookSolver) {
  const MeasurementLog log = test::circle_log({});
  const test::NaiveLeastSquares reference = test::least_squares(log, 20);
  for (const std::string name : {"ceres_pose_graph", "sparse_gauss_newton"}) {
    const auto incremental = solved(name, log, exactly());
    const auto batch =
        builtin_estimators().find(name).create({log.origin(), SolveMode::batch}, exactly());
    EXPECT_EQ(test::feed(*batch, log), Outcome::converged);
    for (const Estimator* graph : {incremental.get(), batch.get()}) {
      EXPECT_LT(largest_distance(poses_of(*graph), reference.poses), 1e-8) << name;
      EXPECT_NEAR(chi2(log, poses_of(*graph)), chi2(log, reference.poses), 1e-8) << name;
    }
    for (std::size_t k = 1; k < log.size(); ++k) {
      EXPECT_LT((*batch->covariance(k) - reference.marginal(k)).norm(), 1e-9) << name;
    }
  }
}

// With noise each filter has linearisations of its own; the graphs share the optimum and its
// Hessian.
// Of a loop that holds a constraint ever more precisely F has a limit.
TEST(CrossEstimator, TheGraphsReachTheOptimumOfAPreciseLoopOrSayThatTheyDoNot) {
  for (const std::size_t from : {std::size_t{0}, std::size_t{7}}) {
    const MeasurementLog precise = test::with_precise_loop(from, 1e9);
    const double limit = chi2(precise, test::least_squares(precise, 10).poses);
    for (int exponent = 10; exponent <= 40; ++exponent) {
      const MeasurementLog log = test::with_precise_loop(from, std::pow(10.0, exponent));
      for (const char* type : {"ceres_pose_graph", "sparse_gauss_newton", "incremental_smoother"}) {
        const auto estimator = builtin_estimators().find(type).create({}, {});
        if (!is_done(test::feed(*estimator, log))) continue;
        EXPECT_LT(chi2(log, poses_of(*estimator)), 1.01 * limit + 0.1)
            << type << ", from " << from << ", information 1e" << exponent;
      }
    }
  }
}

TEST(CrossEstimator, TheGraphsAgreeOnTheCovariancesOfNoisyMeasurements) {
  const MeasurementLog log = test::circle_log({});
  const auto reference = solved("ceres_pose_graph", log, exactly());
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    if (entry.name == "ekf" || entry.name == "trajectory_iekf") continue;
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
    if (entry.name == "ekf" || entry.name == "trajectory_iekf") continue;
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
Eigen::MatrixXd jacobian_of_poses(const Estimator& estimator) {
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

TEST(CrossEstimator, ABatchSolveStartsWhereItIsTold) {
  const MeasurementLog log = test::circle_log({});
  const auto one_step = [&](std::span<const Pose> start) {
    const auto graph =
        builtin_estimators()
            .find("ceres_pose_graph")
            .create({log.origin(), SolveMode::batch}, test::values({{"max_iterations", "1"}}));
    for (std::size_t k = 1; k < log.size(); ++k) {
      graph->add_keyframe(log.arrival(k).step);
      graph->close_loops(log.arrival(k).registrations);
    }
    graph->finish(start);
    return chi2(log, poses_of(*graph));
  };
  const test::NaiveLeastSquares reference = test::least_squares(log, 20);
  EXPECT_NEAR(one_step(reference.poses), chi2(log, reference.poses), 1e-9);
  EXPECT_GT(one_step({}), chi2(log, reference.poses) + 1e-6);
}

TEST(CrossEstimator, ABatchSolveRefusesAGate) {
  EXPECT_THROW(builtin_estimators()
                   .find("ceres_pose_graph")
                   .create({{}, SolveMode::batch}, test::values({{"gate_probability", "0.99"}})),
               InputError);
}

// One loop that is off by 500 sigma among right ones: a robust loss all but leaves it out.
TEST(CrossEstimator, RobustLossesLimitAWrongLoop) {
  MeasurementLog log = test::circle_log({});
  const std::size_t k = log.size();
  log.add_keyframe(
      RelativePose::from_covariance(k - 1, k, log.arrival(k - 1).step.motion,
                                    test::full_covariance(test::kStepSigmaM, test::kStepSigmaRad)));
  const std::vector<Pose> clean = poses_of(*solved("ceres_pose_graph", log));
  const Pose right = between(clean[8], clean[k]);
  log.add_registration(RelativePose::from_covariance(
      8, k, {right.x + 5.0, right.y - 5.0, right.theta}, test::full_covariance(0.01, 0.005)));
  const auto shift = [&](const std::string& loss) {
    return largest_distance(
        poses_of(*solved("ceres_pose_graph", log, test::values({{"loss", loss}}))), clean);
  };
  EXPECT_GT(shift("none"), 1.0);
  EXPECT_LT(shift("huber"), 0.5 * shift("none"));
  EXPECT_LT(shift("cauchy"), 0.1 * shift("none"));
  EXPECT_LT(shift("dcs"), 0.1 * shift("none"));
  EXPECT_LT(shift("geman_mcclure"), 0.1 * shift("none"));
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
  const auto of_last = [&](Estimator& estimator) { return *estimator.covariance(log.size() - 1); };
  const Eigen::Matrix3d motion = robust->motions_to_newest()->front().covariance;
  EXPECT_LT((motion - of_last(*robust)).norm(), 1e-8 * motion.norm());
  EXPECT_GT((motion - of_last(*plain)).norm(), 1e-2 * motion.norm());
}

}  // namespace
}  // namespace fathom
