#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "estimators/ekf/ekf.hpp"
#include "estimators/trajectory_iekf/stretch.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive_filters.hpp"

namespace fathom {
namespace {

using test::largest_distance;
using test::largest_turn;
using test::LogOptions;
using test::solved;

TEST(Stretch, JacobianEqualsCentralDifferences) {
  RandomStream random(2, "stretch");
  for (const double around : {0.0, M_PI, 1e-9}) {
    std::vector<Pose> motions;
    for (int i = 0; i < 8; ++i) {
      motions.push_back({random.uniform(-2, 2), random.uniform(-2, 2),
                         wrap_angle(around + random.uniform(-0.2, 0.2))});
    }
    const std::size_t first = 4;
    for (const std::size_t from : {first, first + 3, first + 7}) {
      const Eigen::Matrix3Xd H = Stretch(first, motions).H(from);
      for (Eigen::Index column = 0; column < H.cols(); ++column) {
        const double step = 1e-6;
        const auto moved = [&](double by) {
          std::vector<Pose> at = motions;
          Eigen::Vector3d v = at[static_cast<std::size_t>(column / 3)].vector();
          v(column % 3) += by;
          at[static_cast<std::size_t>(column / 3)] = Pose::from_vector(v);
          return Stretch(first, at).h(from).vector();
        };
        Eigen::Vector3d difference = moved(step) - moved(-step);
        difference.z() = wrap_angle(difference.z());
        EXPECT_LT((H.col(column) - difference / (2 * step)).norm(), 1e-7);
      }
    }
  }
}

TEST(TrajectoryIekf, EqualsTheTextbookFilterAtAnyNumberOfLinearisations) {
  LogOptions options;
  options.keyframes = 60;
  options.origin = {5.0, -3.0, 2.0};
  const MeasurementLog log = test::circle_log(options);
  for (const int iterations : {1, 2, 3, 5}) {
    const auto ours = solved(
        "trajectory_iekf", log,
        test::values({{"max_iterations", std::to_string(iterations)}, {"tolerance", "1e-300"}}));
    const std::vector<Pose> reference =
        test::run_naive(test::NaiveTrajectoryIekf(log, iterations), log);
    EXPECT_LT(largest_distance(poses_of(*ours), reference), 1e-6) << iterations;
    EXPECT_LT(largest_turn(poses_of(*ours), reference), 1e-6) << iterations;
  }
}

TEST(Ekf, EqualsTheTextbookFilter) {
  LogOptions options;
  options.keyframes = 60;
  options.origin = {5.0, -3.0, 2.0};
  const MeasurementLog log = test::circle_log(options);
  const auto ours = solved("ekf", log);
  const std::vector<Pose> reference = test::run_naive(test::NaiveEkf(log), log);
  EXPECT_LT(largest_distance(poses_of(*ours), reference), 1e-6);
  EXPECT_LT(largest_turn(poses_of(*ours), reference), 1e-6);
}

// A filter that starts every pass from the prior with the old prediction is an EKF that only costs
// more: its passes change nothing.
TEST(TrajectoryIekf, IterationsChangeTheEstimateAndLowerTheCost) {
  LogOptions options;
  options.loops_at_end_only = true;
  options.noise = 4.0;
  const MeasurementLog log = test::circle_log(options);
  const auto at = [&](int iterations) {
    return poses_of(*solved("trajectory_iekf", log,
                            test::values({{"max_iterations", std::to_string(iterations)}})));
  };
  const std::vector<Pose> one = at(1);
  const std::vector<Pose> two = at(2);
  const std::vector<Pose> ten = at(10);
  EXPECT_GT(largest_distance(one, two), 1e-3);
  EXPECT_LT(largest_distance(two, ten), largest_distance(one, ten));
  EXPECT_LT(chi2(log, ten), chi2(log, one));
}

TEST(TrajectoryIekf, CountsLinearisationsAndReportsItsLimit) {
  LogOptions options;
  options.loops_at_end_only = true;
  options.noise = 4.0;
  const MeasurementLog log = test::circle_log(options);
  for (const int limit : {1, 2, 50}) {
    TrajectoryIekf filter({}, [&] {
      TrajectoryIekfOptions set;
      set.max_iterations = limit;
      return set;
    }());
    UpdateReport report;
    for (std::size_t k = 1; k < log.size(); ++k) {
      filter.add_keyframe(log.arrival(k).step);
      if (!log.arrival(k).registrations.empty()) {
        report = filter.close_loops(log.arrival(k).registrations);
      }
    }
    if (limit < 50) {
      EXPECT_EQ(report.iterations, limit);
      EXPECT_EQ(report.outcome, Outcome::iteration_limit);
    } else {
      EXPECT_LT(report.iterations, 50);
      EXPECT_EQ(report.outcome, Outcome::converged);
    }
    EXPECT_EQ(report.loops.size(), 3U);
  }
}

// The covariance of a pose is mapped from the stacked motions' by the whole Jacobian at once here,
// and recursively in the filter.
TEST(TrajectoryIekf, PoseCovariancesAreTheStateCovarianceMappedByTheChainJacobian) {
  const MeasurementLog log = test::circle_log({});
  TrajectoryIekf filter({log.origin()}, {});
  test::feed(filter, log);
  const Eigen::MatrixXd P = filter.state_covariance().full();
  std::vector<Pose> motions;
  for (std::size_t k = 1; k < log.size(); ++k) {
    motions.push_back(between(filter.pose(k - 1), filter.pose(k)));
  }
  for (const std::size_t k : {std::size_t{1}, std::size_t{17}, log.size() - 1}) {
    const Stretch stretch(0, std::span(motions).first(k));
    const Eigen::Matrix3Xd H = stretch.H(0);
    const Eigen::Matrix3d expected = H * P.topLeftCorner(H.cols(), H.cols()) * H.transpose();
    EXPECT_LT((*filter.covariance(k) - expected).norm(), 1e-12 + 1e-9 * expected.norm());
  }
}

TEST(TrajectoryIekf, TheSafeguardNeverEndsAboveThePriorCost) {
  // A loop that asks for a half turn of a long chain: plain iterations swing about.
  MeasurementLog log;
  for (std::size_t k = 1; k <= 30; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.0, 0.0, 0.0},
                                                   test::full_covariance(0.02, 0.08)));
  }
  log.add_registration(
      RelativePose::from_covariance(0, 30, {0.0, 5.0, 3.0}, test::full_covariance(0.05, 0.05)));
  const double before = chi2(log, log.odometry());
  double last = before;
  for (const int iterations : {1, 2, 4, 8, 16, 32}) {
    const auto filter = solved(
        "trajectory_iekf", log,
        test::values({{"max_iterations", std::to_string(iterations)}, {"safeguard", "true"}}));
    const double now = chi2(log, poses_of(*filter));
    EXPECT_LE(now, last * (1.0 + 1e-9)) << iterations;
    last = now;
  }
  EXPECT_LT(last, 0.1 * before);
}

TEST(TrajectoryIekf, AnUpdateThatEndsFarAboveThePriorCostHasDivergedAndIsNotTaken) {
  // The position is right and the heading off by 3 rad. With levers of 20 m and 10 m the linearised
  // answer is to turn by −3 and 6 rad, which throws the true position far off.
  MeasurementLog log;
  const auto covariance = [](double heading) -> Eigen::Matrix3d {
    return Eigen::Vector3d(1e-8, 1e-8, heading).asDiagonal();
  };
  for (std::size_t k = 1; k <= 3; ++k) {
    log.add_keyframe(
        RelativePose::from_covariance(k - 1, k, {10.0, 0.0, 0.0}, covariance(k < 3 ? 4.0 : 1e-8)));
  }
  log.add_registration(RelativePose::from_covariance(
      0, 3, {30.0, 0.0, 3.0}, Eigen::Vector3d(1e-2, 1e-2, 1e-2).asDiagonal()));
  const auto filter = builtin_estimators()
                          .find("trajectory_iekf")
                          .create({}, test::values({{"max_iterations", "1"}}));
  std::vector<LoopDecision> decisions;
  EXPECT_EQ(test::feed(*filter, log, &decisions), Outcome::diverged);
  ASSERT_EQ(decisions.size(), 1U);
  EXPECT_EQ(decisions.front().fate, LoopFate::lost);
  EXPECT_EQ(poses_of(*filter), log.odometry());
}

}  // namespace
}  // namespace fathom
