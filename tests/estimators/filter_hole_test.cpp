// Both filters where dead reckoning has holes that loops take the place of, out of order.

#include <algorithm>

#include <gtest/gtest.h>

#include "src/harness/conformance/naive_least_squares.hpp"
#include "support/planar.hpp"
#include "tests/estimators/cross_estimator.hpp"

namespace fathom::test {
namespace {

constexpr std::size_t kKeyframes = 60;
const std::vector<std::size_t> kHoles{10, 20, 45};

RelativePose hole(std::size_t k, double sigma_m = 100.0, double sigma_rad = 3.0) {
  const Eigen::Vector3d variances(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  RelativePose step =
      RelativePose::from_covariance(k - 1, k, {-3.0, 2.0, 2.0}, variances.asDiagonal());
  step.is_hole = true;
  return step;
}

// Two rounds of 30 keyframes in four stretches, 0 to 9, to 19, to 44 and to 59. The third is joined
// to the first before the second is to either, from within, and has gone on by then. Within the
// second and the third there are loops while they hang in the air.
MeasurementLog four_stretches(double noise, const Pose& origin = {}) {
  LogOptions options;
  options.keyframes = kKeyframes;
  options.noise = noise;
  options.loop_every = 3;
  options.origin = origin;
  const MeasurementLog log = circle_log(options);
  const std::vector<Pose> truth = circle(kKeyframes, origin);
  RandomStream random(4, "short loops");
  MeasurementLog result(origin);
  for (std::size_t k = 0; k < kKeyframes; ++k) {
    const bool is_hole = std::ranges::find(kHoles, k) != kHoles.end();
    if (k > 0) result.add_keyframe(is_hole ? hole(k) : log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) result.add_registration(z);
    if ((k < 13 || k > 19) && (k < 23 || k > 29)) continue;
    result.add_registration(
        RelativePose::from_covariance(k - 3, k,
                                      perturbed(between(truth[k - 3], truth[k]),
                                                noise * kLoopSigmaM, noise * kLoopSigmaRad, random),
                                      full_covariance(kLoopSigmaM, kLoopSigmaRad)));
  }
  return result;
}

class FilterHole : public testing::TestWithParam<std::string> {
 protected:
  std::unique_ptr<Estimator> make(const EstimatorValues& values = {}) const {
    return builtin_estimators().find(GetParam()).create({}, values);
  }
};

INSTANTIATE_TEST_SUITE_P(Both, FilterHole, testing::Values("ekf", "trajectory_iekf"),
                         [](const auto& name) { return name.param; });

// With little noise a filter is as good as its linearisation. Joint covariances too: of keyframes
// of one stretch and of several.
TEST_P(FilterHole, EndsAtTheOptimumWithItsCovariances) {
  for (const Pose& origin : {Pose{}, Pose{30.0, -20.0, 3.0}}) {
    const MeasurementLog log = four_stretches(0.01, origin);
    const auto estimator = builtin_estimators().find(GetParam()).create({origin}, exactly());
    EXPECT_TRUE(is_done(feed(*estimator, log)));
    const NaiveLeastSquares expected = least_squares(log, 10, circle(kKeyframes, origin));
    EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-4);
    const std::vector<std::size_t> some{3, 12, 18, 21, 44, 45, 59, 0, 12};
    const auto joint = estimator->joint_covariance(some);
    ASSERT_TRUE(joint);
    EXPECT_LT(largest_block_difference(*joint, expected.joint(some)), 2e-3);
    for (std::size_t k = 1; k < kKeyframes; ++k) {
      const Eigen::Matrix3d C = expected.marginal(k);
      EXPECT_LT((*estimator->covariance(k) - C).norm(), 2e-3 * C.norm()) << k;
    }
    const auto motions = estimator->motions_to_newest();
    ASSERT_TRUE(motions);
    ASSERT_EQ(motions->size(), kKeyframes - 1);
    for (const std::size_t k : {0, 9, 10, 19, 20, 40, 44, 45, 58}) {
      PairCovariance pair{*estimator->covariance(k), *estimator->covariance(kKeyframes - 1), {}};
      pair.cross = estimator->joint_covariance(std::vector<std::size_t>{k, kKeyframes - 1})
                       ->topRightCorner<3, 3>();
      const Pose from = estimator->pose(k);
      const Pose to = estimator->pose(kKeyframes - 1);
      EXPECT_LT(((*motions)[k].mean.vector() - between(from, to).vector()).norm(), 1e-9) << k;
      const Eigen::Matrix3d C = between(from, to, pair).covariance;
      EXPECT_LT(((*motions)[k].covariance - C).norm(), 1e-6 * C.norm()) << k;
    }
  }
}

// A stretch that hangs in the air has the declared covariance, carried along; loops within it say
// nothing of its heading.
TEST_P(FilterHole, InTheAirThePoseIsAsUncertainAsTheHole) {
  MeasurementLog log = four_stretches(1.0);
  const auto estimator = make();
  for (std::size_t k = 1; k < 20; ++k) {
    estimator->add_keyframe(log.arrival(k).step);
    give(*estimator, log.arrival(k));
  }
  for (const std::size_t k : {10, 15, 19}) {
    const Eigen::Matrix3d C = *estimator->covariance(k);
    EXPECT_NEAR(C(2, 2), 9.0, 0.02) << k;
    EXPECT_GT(C(0, 0), 1e4);
    EXPECT_LT((*estimator->joint_covariance(std::vector<std::size_t>{k}) - C).norm(), 1e-6);
  }
  // Relative to each other the keyframes of a stretch are known.
  const auto motions = estimator->motions_to_newest();
  EXPECT_LT((*motions)[10].covariance.trace(), 0.1);
  EXPECT_GT((*motions)[9].covariance.trace(), 1e4);
}

// By the declared covariance: the hole stays open for a loop that it goes with.
TEST_P(FilterHole, AGateRejectsALoopThatTheHoleCannotBe) {
  const std::vector<Pose> truth = circle(30);
  const auto estimator = make(values({{"gate_probability", "0.99"}}));
  for (std::size_t k = 1; k < 20; ++k) {
    estimator->add_keyframe(
        k == 10 ? hole(k, 5.0)
                : RelativePose::from_covariance(k - 1, k, between(truth[k - 1], truth[k]),
                                                full_covariance(kStepSigmaM, kStepSigmaRad)));
  }
  const std::vector<Pose> before = poses_of(*estimator);
  const Eigen::Matrix3d C = full_covariance(kLoopSigmaM, kLoopSigmaRad);
  const auto wrong = RelativePose::from_covariance(5, 19, {500.0, 0.0, 0.0}, C);
  UpdateReport report = estimator->update({std::span(&wrong, 1)});
  ASSERT_EQ(report.loops.size(), 1U);
  EXPECT_EQ(report.loops[0].fate, LoopFate::rejected);
  EXPECT_GT(report.loops[0].nis.value(), 11.34);
  EXPECT_EQ(largest_distance(poses_of(*estimator), before), 0.0);
  // Given the other way round: the decision is too.
  const auto right = RelativePose::from_covariance(19, 5, between(truth[19], truth[5]), C);
  report = estimator->update({std::span(&right, 1)});
  EXPECT_EQ(report.loops[0].from, 19U);
  EXPECT_EQ(report.loops[0].fate, LoopFate::used);
  EXPECT_LT(report.loops[0].nis.value(), 11.34);
  EXPECT_LT(largest_distance(poses_of(*estimator), std::span(truth).first(20)), 1e-9);
}

// One whose heading is declared well enough for a linearisation is a step like others.
TEST_P(FilterHole, ANarrowOneIsAStep) {
  LogOptions options;
  const MeasurementLog log = circle_log(options);
  MeasurementLog holed;
  MeasurementLog plain;
  for (std::size_t k = 1; k < log.size(); ++k) {
    RelativePose step = log.arrival(k).step;
    if (k == 15) step.information /= 100.0;
    plain.add_keyframe(step);
    step.is_hole = k == 15;
    holed.add_keyframe(step);
    for (const RelativePose& z : log.arrival(k).registrations) {
      plain.add_registration(z);
      holed.add_registration(z);
    }
  }
  const auto a = make();
  const auto b = make();
  feed(*a, holed);
  feed(*b, plain);
  EXPECT_EQ(largest_distance(poses_of(*a), poses_of(*b)), 0.0);
  EXPECT_EQ((*a->covariance(39) - *b->covariance(39)).norm(), 0.0);
}

// The first knowledge of a hole is a heading and a fix; the loop that follows is an update.
TEST_P(FilterHole, MeasuredInTheWorldFirst) {
  const std::vector<Pose> truth = circle(30);
  MeasurementLog log;
  for (std::size_t k = 1; k < 30; ++k) {
    RelativePose step = RelativePose::from_covariance(k - 1, k, between(truth[k - 1], truth[k]),
                                                      full_covariance(kStepSigmaM, kStepSigmaRad));
    log.add_keyframe(k == 10 ? hole(k) : step);
    if (k == 12) log.add_absolute(AbsolutePose::heading(k, truth[k].theta, 0.02));
    if (k == 13) {
      log.add_absolute(AbsolutePose::position(k, truth[k].position(), Eigen::Matrix2d::Identity()));
    }
    if (k == 25) {
      log.add_registration(RelativePose::from_covariance(
          5, k, between(truth[5], truth[k]), full_covariance(kLoopSigmaM, kLoopSigmaRad)));
    }
  }
  const auto estimator = make(exactly());
  EXPECT_TRUE(is_done(feed(*estimator, log)));
  EXPECT_LT(largest_distance(poses_of(*estimator), truth), 0.2);
  const NaiveLeastSquares expected = least_squares(log, 10, truth);
  for (const std::size_t k : {9, 12, 25, 29}) {
    const Eigen::Matrix3d C = expected.marginal(k);
    EXPECT_LT((*estimator->covariance(k) - C).norm(), 0.1 * C.norm()) << k;
  }
}

// Ten keyframes in a row with nothing but a heading, and with loops of some: those are known.
TEST_P(FilterHole, AStretchOfHolesWithACompass) {
  LogOptions options;
  options.keyframes = kKeyframes;
  options.noise = 0.01;
  options.loop_every = 3;
  const MeasurementLog plain = circle_log(options);
  const std::vector<Pose> truth = circle(kKeyframes);
  MeasurementLog log;
  for (std::size_t k = 1; k < kKeyframes; ++k) {
    RelativePose step = hole(k, 25.0, 1.8);
    step.motion = {};
    log.add_keyframe(k > 30 && k <= 40 ? step : plain.arrival(k).step);
    for (const RelativePose& z : plain.arrival(k).registrations) log.add_registration(z);
    log.add_absolute(AbsolutePose::heading(k, truth[k].theta, 0.0175));
  }
  const auto estimator = make(exactly());
  EXPECT_TRUE(is_done(feed(*estimator, log)));
  for (const std::size_t k : {30, 33, 36, 39, 41, 50, 59}) {
    EXPECT_LT(distance(estimator->pose(k), truth[k]), 2e-3) << k;
  }
}

}  // namespace
}  // namespace fathom::test
