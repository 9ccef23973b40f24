// Estimators against each other: what the framework exists for.

#include "tests/estimators/cross_estimator.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

using test::exactly;
using test::largest_distance;
using test::largest_turn;
using test::loops_at_the_end;
using test::solved;

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

TEST(CrossEstimator, ABatchSolveStartsWhereItIsTold) {
  const MeasurementLog log = test::circle_log({});
  const auto one_step = [&](std::span<const Pose> start) {
    const auto graph =
        builtin_estimators()
            .find("ceres_pose_graph")
            .create({log.origin(), SolveMode::batch}, test::values({{"max_iterations", "1"}}));
    for (std::size_t k = 1; k < log.size(); ++k) {
      graph->add_keyframe(log.arrival(k).step);
      graph->update({log.arrival(k).registrations});
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

}  // namespace
}  // namespace fathom
