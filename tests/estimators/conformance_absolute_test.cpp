// What every estimator of the registry must do with absolute measurements and an uncertain start.

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/estimators/conformance.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/naive_least_squares.hpp"
#include "tests/estimators/world_logs.hpp"

namespace fathom::test {
namespace {

using ConformanceAbsolute = Conformance;

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) all.push_back(entry.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Every, ConformanceAbsolute, testing::ValuesIn(names()),
                         [](const auto& name) { return name.param; });

TEST_P(ConformanceAbsolute, AStartWithCovarianceIsThatOfKeyframeZero) {
  const StartPose start = uncertain_start({3.0, -2.0, 2.5}, 0.4, 0.1);
  const auto estimator = make(start);
  ASSERT_EQ(estimator->size(), 1U);
  EXPECT_LT((estimator->pose(0).vector() - start.pose.vector()).norm(), 1e-14);
  ASSERT_TRUE(estimator->covariance(0));
  EXPECT_LT((*estimator->covariance(0) - start.covariance).norm(), 1e-12);
}

// Without absolute measurements a start's uncertainty moves nothing, and comes on top: a turn of
// the whole map about keyframe 0, and a shift.
TEST_P(ConformanceAbsolute, AnUncertainStartCarriesOverToEveryKeyframe) {
  if (GetParam() == "ekf") {
    GTEST_SKIP() << "an EKF on poses learns from loops what they do not say of the map's heading: "
                    "its Jacobians are of different estimates (docs/absolute_measurements.md)";
  }
  const MeasurementLog plain = circle_log({.origin = {1.0, 2.0, -3.0}});
  MeasurementLog log = plain;
  log.set_start(uncertain_start(plain.origin(), 0.3, 0.05));
  const auto fixed = solved(GetParam(), plain, exactly());
  const auto free = solved(GetParam(), log, exactly());
  EXPECT_LT(largest_distance(poses_of(*free), poses_of(*fixed)), 1e-9);
  for (std::size_t k = 0; k < log.size(); ++k) {
    Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
    const Eigen::Vector2d lever = fixed->pose(k).position() - fixed->pose(0).position();
    J.topRightCorner<2, 1>() << -lever.y(), lever.x();
    const Eigen::Matrix3d expected = *fixed->covariance(k) + transport(J, log.start().covariance);
    EXPECT_LT((*free->covariance(k) - expected).norm(), 1e-7 * expected.norm()) << k;
  }
}

TEST_P(ConformanceAbsolute, ExactMeasurementsMoveNothingAndSharpenTheEstimate) {
  LogOptions plain;
  plain.noise = 0.0;
  WorldOptions options;
  options.noise = 0.0;
  options.pose_every = 9;
  options.start = uncertain_start({5.0, 1.0, 3.0}, 0.2, 0.05);
  const MeasurementLog log = circle_in_world(options, plain);
  const auto estimator = make(log.start(), exactly());
  EXPECT_EQ(feed(*estimator, log), Outcome::converged);
  EXPECT_LT(largest_distance(poses_of(*estimator), circle(plain.keyframes, log.origin())), 1e-9);
  EXPECT_LT(estimator->covariance(0)->trace(), 0.9 * log.start().covariance.trace());
}

// Zero information is no measurement, to the last bit.
TEST_P(ConformanceAbsolute, MeasurementsWithoutInformationChangeNothing) {
  const MeasurementLog plain = circle_log({});
  MeasurementLog log;
  for (std::size_t k = 1; k < plain.size(); ++k) {
    log.add_keyframe(plain.arrival(k).step);
    for (const RelativePose& z : plain.arrival(k).registrations) log.add_registration(z);
    // An update of its own would have its own iterations.
    if (!plain.arrival(k).registrations.empty()) log.add_absolute({k, {100.0, -50.0, 1.0}});
  }
  const auto with = solved(GetParam(), log);
  const auto without = solved(GetParam(), plain);
  for (std::size_t k = 0; k < log.size(); ++k) {
    EXPECT_EQ(with->pose(k), without->pose(k)) << k;
    EXPECT_EQ(*with->covariance(k), *without->covariance(k)) << k;
  }
}

// Headings known to 1e-7 rad and measured without error: what is left is linear in the positions.
TEST_P(ConformanceAbsolute, LinearCasesAreThoseOfLeastSquares) {
  RandomStream random(3, "linear");
  StartPose start({1.0, 2.0, 0.7});
  start.covariance = Eigen::Vector3d(0.04, 0.09, 1e-14).asDiagonal();
  MeasurementLog log(start);
  const Eigen::Matrix3d step = Eigen::Vector3d(0.01, 0.02, 1e-14).asDiagonal();
  const Eigen::Matrix3d loop = Eigen::Vector3d(0.003, 0.001, 1e-14).asDiagonal();
  const auto noisy = [&](double x, double y, double sigma) {
    return Pose{x + sigma * random.normal(), y + sigma * random.normal(), 0.0};
  };
  for (std::size_t k = 1; k < 12; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, noisy(1.0, 0.2, 0.1), step));
    if (k % 4 == 0) {
      log.add_registration(RelativePose::from_covariance(k - 4, k, noisy(4.0, 0.8, 0.05), loop));
    }
    if (k % 3 == 0) {
      const Eigen::Vector2d at = transform(log.origin(), {1.0 * k, 0.2 * k});
      const Pose error = noisy(0.0, 0.0, 0.3);
      log.add_absolute(AbsolutePose::position(k, at + error.position(), fix_covariance(0.3)));
    }
    if (k % 5 == 0) log.add_absolute(AbsolutePose::heading(k, 0.7, 1e-7));
  }
  const NaiveLeastSquares expected = least_squares(log, 6);
  const auto estimator =
      solved(GetParam(), log, values({{"tolerance", "1e-18"}, {"max_iterations", "100"}}));
  EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-9);
  for (std::size_t k = 0; k < log.size(); ++k) {
    const Eigen::Matrix2d C = estimator->covariance(k)->topLeftCorner<2, 2>();
    const Eigen::Matrix2d expected_C = expected.marginal(k).topLeftCorner<2, 2>();
    EXPECT_LT((C - expected_C).norm(), 1e-9 * expected_C.norm()) << k;
  }
}

TEST_P(ConformanceAbsolute, APriorOfANanometreOnEveryKeyframePutsTheEstimateOnIt) {
  const MeasurementLog plain = circle_log({});
  const std::vector<Pose> truth = circle(LogOptions{}.keyframes);
  WorldOptions options;
  options.position_sigma_m = 1e-9;
  options.heading_sigma_rad = 1e-9;
  options.noise = 0.0;
  options.position_every = 1;
  options.start = uncertain_start({}, 1.0, 0.5);
  const auto estimator = make(options.start);
  const MeasurementLog log = in_world(plain, truth, options);
  EXPECT_TRUE(is_done(feed(*estimator, log)));
  EXPECT_LT(largest_distance(poses_of(*estimator), truth), 1e-8);
  EXPECT_LT(largest_turn(poses_of(*estimator), truth), 1e-8);
}

TEST_P(ConformanceAbsolute, TurningTheWorldTurnsTheResult) {
  for (const double turn : {0.3, 2.0, M_PI, -3.1}) {
    const Pose world{7.0, -4.0, turn};
    WorldOptions options;
    options.start = uncertain_start({0.5, 1.0, 0.2}, 0.2, 0.03);
    options.pose_every = 11;
    const MeasurementLog log = circle_in_world(options);
    StartPose start = log.start();
    Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
    R.topLeftCorner<2, 2>() = rotation(turn);
    start.pose = compose(world, start.pose);
    start.covariance = transport(R, start.covariance);
    MeasurementLog turned(start);
    for (std::size_t k = 0; k < log.size(); ++k) {
      if (k > 0) turned.add_keyframe(log.arrival(k).step);
      for (const RelativePose& z : log.arrival(k).registrations) turned.add_registration(z);
      for (AbsolutePose z : log.arrival(k).absolute) {
        z.pose = compose(world, z.pose);
        turned.add_absolute(z);
      }
    }
    const auto a = solved(GetParam(), log, exactly());
    const auto b = solved(GetParam(), turned, exactly());
    for (std::size_t k = 0; k < log.size(); ++k) {
      const Pose expected = compose(world, a->pose(k));
      EXPECT_LT((b->pose(k).position() - expected.position()).norm(), 1e-8) << k;
      EXPECT_LT(std::abs(wrap_angle(b->pose(k).theta - expected.theta)), 1e-8) << k;
      const Eigen::Matrix3d C = transport(R, *a->covariance(k));
      EXPECT_LT((*b->covariance(k) - C).norm(), 1e-6 * C.norm()) << k;
    }
  }
}

TEST_P(ConformanceAbsolute, RepeatsToTheLastBit) {
  WorldOptions options;
  options.start = uncertain_start({}, 0.2, 0.03);
  const MeasurementLog log = circle_in_world(options);
  const auto a = solved(GetParam(), log);
  const auto b = solved(GetParam(), log);
  for (std::size_t k = 0; k < log.size(); ++k) {
    EXPECT_EQ(a->pose(k), b->pose(k));
    EXPECT_EQ(*a->covariance(k), *b->covariance(k));
  }
}

// A jump of a fix is a wrong loop to the world.
TEST_P(ConformanceAbsolute, AGateRefusesAFixThatJumps) {
  WorldOptions options;
  options.position_every = 4;
  MeasurementLog log = circle_in_world(options);
  const auto estimator = make(log.start(), values({{"gate_probability", "0.9999"}}));
  std::size_t rejected = 0;
  std::size_t jumps = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k > 0) estimator->add_keyframe(log.arrival(k).step);
    KeyframeMeasurements arrival = log.arrival(k);
    if (k == 20 || k == 32) {
      arrival.absolute.back().pose.x += 20.0;
      ++jumps;
    }
    const UpdateReport report = estimator->update({arrival.registrations, arrival.absolute});
    ASSERT_EQ(report.absolute.size(), arrival.absolute.size());
    for (std::size_t j = 0; j < report.absolute.size(); ++j) {
      EXPECT_EQ(report.absolute[j].keyframe, k);
      if (report.absolute[j].fate == LoopFate::used) continue;
      EXPECT_EQ(report.absolute[j].fate, LoopFate::rejected);
      EXPECT_GT(report.absolute[j].nis.value(), 100.0);
      ++rejected;
    }
  }
  EXPECT_EQ(rejected, jumps);
  EXPECT_LT(largest_distance(poses_of(*estimator), circle(log.size())), 0.5);
}

TEST_P(ConformanceAbsolute, ANaNIsAFailureAndLeavesTheEstimateAsItWas) {
  const MeasurementLog log = circle_log({});
  const auto estimator = solved(GetParam(), log);
  const std::vector<Pose> before = poses_of(*estimator);
  estimator->add_keyframe(log.arrival(1).step);
  AbsolutePose bad = AbsolutePose::heading(log.size(), 0.3, 0.1);
  bad.pose.theta = std::numeric_limits<double>::quiet_NaN();
  const UpdateReport report = estimator->update({{}, std::span(&bad, 1)});
  EXPECT_EQ(report.outcome, Outcome::numerical_failure);
  ASSERT_EQ(report.absolute.size(), 1U);
  EXPECT_EQ(report.absolute[0].fate, LoopFate::lost);
  for (std::size_t k = 0; k < before.size(); ++k) EXPECT_EQ(estimator->pose(k), before[k]);
}

// Against the full least squares; filters linearise once a keyframe and are near it.
TEST_P(ConformanceAbsolute, AgreesWithLeastSquares) {
  WorldOptions options;
  options.start = uncertain_start({2.0, -1.0, 3.1}, 0.2, 0.03);
  options.pose_every = 13;
  const MeasurementLog log = circle_in_world(options);
  const NaiveLeastSquares expected = least_squares(log, 10);
  const auto estimator = solved(GetParam(), log, exactly());
  const bool is_filter = GetParam() == "ekf" || GetParam() == "trajectory_iekf";
  EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), is_filter ? 0.02 : 1e-7);
  for (std::size_t k = 0; k < log.size(); ++k) {
    const Eigen::Matrix3d C = expected.marginal(k);
    EXPECT_LT((*estimator->covariance(k) - C).norm(), (is_filter ? 0.1 : 1e-4) * C.norm()) << k;
  }
  std::vector<std::size_t> some{0, 7, 3, 39};
  EXPECT_LT(largest_block_difference(*estimator->joint_covariance(some), expected.joint(some)),
            is_filter ? 0.1 : 1e-4);
}

}  // namespace
}  // namespace fathom::test
