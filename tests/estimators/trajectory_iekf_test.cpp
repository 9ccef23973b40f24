#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "estimators/ekf/ekf.hpp"
#include "estimators/trajectory_iekf/stretch.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive.hpp"

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

// A survey whose loops go back a few keyframes only, or one or two rounds, two or three at once;
// every seventh update has a false one.
MeasurementLog local_and_wide_loops() {
  LogOptions plain;
  plain.keyframes = 90;
  plain.loop_every = 0;
  plain.noise = 2.0;
  plain.origin = {40.0, -30.0, 3.1};
  MeasurementLog log = test::circle_log(plain);
  const std::vector<Pose> truth = test::circle(plain.keyframes, plain.origin);
  RandomStream random(8, "loops");
  MeasurementLog result(log.origin());
  for (std::size_t k = 1; k < log.size(); ++k) {
    result.add_keyframe(log.arrival(k).step);
    if (k < 10 || k % 4 != 0) continue;
    for (const std::size_t back : {std::size_t{3}, std::size_t{7}, std::size_t{45}}) {
      if (back > k || (k > 60 && back == 45)) continue;
      Pose z = test::perturbed(between(truth[k - back], truth[k]), test::kLoopSigmaM,
                               test::kLoopSigmaRad, random);
      if (k % 28 == 0 && back == 7) z.x += 3.0;
      result.add_registration(RelativePose::from_covariance(
          k - back, k, z, test::full_covariance(test::kLoopSigmaM, test::kLoopSigmaRad)));
    }
  }
  return result;
}

struct FormCase {
  std::string name;
  TrajectoryIekfOptions options;
};

std::vector<FormCase> form_cases() {
  std::vector<FormCase> cases(4);
  cases[0].name = "plain";
  cases[1].name = "one linearisation";
  cases[1].options.max_iterations = 1;
  cases[2].name = "gated";
  cases[2].options.gate.probability = 0.9999;
  cases[3].name = "safeguarded";
  cases[3].options.safeguard = true;
  return cases;
}

TEST(TrajectoryIekf, TheFormsOfItsCovarianceGiveTheSameToRounding) {
  using Form = MotionCovariance::Form;
  LogOptions options;
  options.keyframes = 60;
  const MeasurementLog rounds = test::circle_log(options);
  const MeasurementLog mixed = local_and_wide_loops();
  for (const FormCase& test : form_cases()) {
    for (const MeasurementLog* log : {&rounds, &mixed}) {
      TrajectoryIekf dense({log->origin()}, test.options, Form::dense);
      std::vector<LoopDecision> decisions;
      const Outcome outcome = test::feed(dense, *log, &decisions);
      const auto motions = *dense.motions_to_newest();
      for (const Form form : {Form::few_loops, Form::cheapest}) {
        TrajectoryIekf other({log->origin()}, test.options, form);
        std::vector<LoopDecision> others;
        EXPECT_EQ(test::feed(other, *log, &others), outcome) << test.name;
        ASSERT_EQ(others.size(), decisions.size());
        for (std::size_t j = 0; j < others.size(); ++j) {
          EXPECT_EQ(others[j].fate, decisions[j].fate) << test.name;
          EXPECT_NEAR(*others[j].nis, *decisions[j].nis, 1e-9 * (1.0 + *decisions[j].nis));
        }
        EXPECT_LT(largest_distance(poses_of(other), poses_of(dense)), 1e-9) << test.name;
        EXPECT_LT(largest_turn(poses_of(other), poses_of(dense)), 1e-9) << test.name;
        for (std::size_t k = 1; k < log->size(); ++k) {
          const Eigen::Matrix3d of_pose = *dense.covariance(k);
          EXPECT_LT((*other.covariance(k) - of_pose).norm(), 1e-9 * of_pose.norm()) << test.name;
          const Eigen::Matrix3d of_motion = motions[k - 1].covariance;
          EXPECT_LT(((*other.motions_to_newest())[k - 1].covariance - of_motion).norm(),
                    1e-9 * of_motion.norm())
              << test.name;
        }
      }
    }
  }
}

// The gate leaves some registrations of an update and refuses others, the earliest among them.
TEST(TrajectoryIekf, AGatedUpdateIsThatOfTheRegistrationsThatPass) {
  const MeasurementLog log = local_and_wide_loops();
  TrajectoryIekfOptions options;
  options.gate.probability = 0.9999;
  TrajectoryIekf gated({log.origin()}, options);
  TrajectoryIekf given({log.origin()}, {});
  std::size_t rejected = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    gated.add_keyframe(log.arrival(k).step);
    given.add_keyframe(log.arrival(k).step);
    const UpdateReport report = gated.close_loops(log.arrival(k).registrations);
    std::vector<RelativePose> passed;
    for (std::size_t j = 0; j < report.loops.size(); ++j) {
      if (report.loops[j].fate == LoopFate::used) passed.push_back(log.arrival(k).registrations[j]);
    }
    rejected += report.loops.size() - passed.size();
    given.close_loops(passed);
  }
  EXPECT_GE(rejected, 2U);
  EXPECT_LT(largest_distance(poses_of(gated), poses_of(given)), 1e-9);
  const Eigen::MatrixXd P = given.state_covariance().full();
  EXPECT_LT((gated.state_covariance().full() - P).norm(), 1e-9 * P.norm());
}

TEST(TrajectoryIekf, WithFewLoopsEqualsTheTextbookFilter) {
  const MeasurementLog log = local_and_wide_loops();
  TrajectoryIekfOptions options;
  options.max_iterations = 3;
  options.tolerance = 1e-300;
  for (const auto form : {MotionCovariance::Form::few_loops, MotionCovariance::Form::dense}) {
    TrajectoryIekf filter({log.origin()}, options, form);
    test::feed(filter, log);
    const std::vector<Pose> reference = test::run_naive(test::NaiveTrajectoryIekf(log, 3), log);
    EXPECT_LT(largest_distance(poses_of(filter), reference), 1e-6);
    EXPECT_LT(largest_turn(poses_of(filter), reference), 1e-6);
  }
}

TEST(TrajectoryIekf, ALostUpdateLeavesTheCovarianceInEitherForm) {
  const MeasurementLog log = test::circle_log({});
  for (const auto form : {MotionCovariance::Form::few_loops, MotionCovariance::Form::dense}) {
    TrajectoryIekf filter({log.origin()}, {}, form);
    test::feed(filter, log);
    filter.add_keyframe(log.arrival(1).step);
    const Eigen::MatrixXd before = filter.state_covariance().full();
    RelativePose loop = log.arrival(20).registrations.front();
    loop.from = 0;
    loop.to = log.size();
    loop.motion.x = std::nan("");
    const UpdateReport report = filter.close_loops(std::span(&loop, 1));
    EXPECT_EQ(report.outcome, Outcome::numerical_failure);
    EXPECT_EQ(filter.state_covariance().full(), before);
  }
}

}  // namespace
}  // namespace fathom
