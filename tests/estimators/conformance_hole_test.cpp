// What every estimator of the registry must do where dead reckoning has a hole.

#include <algorithm>

#include <gtest/gtest.h>

#include "fathom/measurements/connected_guess.hpp"
#include "tests/estimators/conformance.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/naive_least_squares.hpp"
#include "tests/estimators/world_logs.hpp"

namespace fathom::test {
namespace {

using ConformanceHole = Conformance;

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const EstimatorEntry& entry : builtin_estimators().entries()) all.push_back(entry.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Every, ConformanceHole, testing::ValuesIn(names()),
                         [](const auto& name) { return name.param; });

RelativePose hole(std::size_t k, const Pose& guess) {
  const Eigen::Vector3d variances(1e4, 1e4, 10.0);
  RelativePose step = RelativePose::from_covariance(k - 1, k, guess, variances.asDiagonal());
  step.is_hole = true;
  return step;
}

MeasurementLog with_holes(const MeasurementLog& log, const std::vector<std::size_t>& at,
                          const Pose& guess) {
  MeasurementLog result(log.start());
  for (std::size_t k = 0; k < log.size(); ++k) {
    const bool is_hole = std::find(at.begin(), at.end(), k) != at.end();
    if (k > 0) result.add_keyframe(is_hole ? hole(k, guess) : log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) result.add_registration(z);
    for (const AbsolutePose& z : log.arrival(k).absolute) result.add_absolute(z);
  }
  return result;
}

// The loops over the hole come keyframes later, when the part after it has a shape of its own.
TEST_P(ConformanceHole, LoopsMakeItKnowledgeWhateverTheGuess) {
  LogOptions options;
  options.loop_every = 4;
  const MeasurementLog log = circle_log(options);
  const std::vector<Pose> truth = circle(options.keyframes);
  for (const Pose& guess : {Pose{}, Pose{-3.0, 2.0, 2.0}, Pose{40.0, -30.0, -3.0}}) {
    for (const bool is_uncertain : {false, true}) {
      MeasurementLog holed = with_holes(log, {22, 30}, guess);
      if (is_uncertain) holed.set_start(uncertain_start({}, 0.01, 0.001));
      ASSERT_EQ(holed.hole_count(), 2U);
      const auto estimator = make(holed.start(), exactly());
      EXPECT_TRUE(is_done(feed(*estimator, holed)));
      EXPECT_LT(largest_distance(poses_of(*estimator), truth), 0.3);
      const NaiveLeastSquares expected = least_squares(holed, 10, truth);
      for (const std::size_t k : {21, 22, 35, 39}) {
        const Eigen::Matrix3d C = expected.marginal(k);
        EXPECT_LT((*estimator->covariance(k) - C).norm(), 0.2 * C.norm()) << k;
      }
    }
  }
}

TEST_P(ConformanceHole, FixesAndHeadingsMakeItKnowledge) {
  LogOptions plain;
  plain.loop_every = 0;
  WorldOptions options;
  options.position_every = 3;
  const MeasurementLog log = with_holes(circle_in_world(options, plain), {24}, {});
  const auto estimator = make(log.start(), exactly());
  EXPECT_TRUE(is_done(feed(*estimator, log)));
  EXPECT_LT(largest_distance(poses_of(*estimator), circle(log.size())), 1.0);
}

// In batch a hole is nothing at all.
TEST_P(ConformanceHole, InBatchItHasNoPart) {
  if (!builtin_estimators().find(GetParam()).can_batch) GTEST_SKIP() << "no batch mode";
  const MeasurementLog log = circle_log({});
  const MeasurementLog holed = with_holes(log, {22, 30}, {5.0, 5.0, 2.0});
  const NaiveLeastSquares expected = least_squares(holed, 20, circle(log.size()));
  const auto estimator =
      builtin_estimators().find(GetParam()).create({holed.start(), SolveMode::batch}, exactly());
  for (std::size_t k = 1; k < holed.size(); ++k) {
    estimator->add_keyframe(holed.arrival(k).step);
    give(*estimator, holed.arrival(k));
  }
  EXPECT_TRUE(is_done(estimator->finish(connected_guess(holed)).outcome));
  EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-7);
  for (std::size_t k = 0; k < holed.size(); ++k) {
    EXPECT_LT((*estimator->covariance(k) - expected.marginal(k)).norm(),
              1e-5 * expected.marginal(k).norm() + 1e-15);
  }
}

// Nothing is known of the start but what a compass and fixes say.
TEST_P(ConformanceHole, AFreeStartIsPutWhereMeasurementsSay) {
  if (!builtin_estimators().find(GetParam()).can_batch) GTEST_SKIP() << "no batch mode";
  for (const std::size_t heading_every : {0U, 5U}) {
    WorldOptions options;
    options.heading_every = heading_every;
    options.start = Pose{20.0, -10.0, 2.0};
    MeasurementLog log = circle_in_world(options);
    StartPose start;
    start.is_free = true;
    log.set_start(start);
    const auto estimator =
        builtin_estimators().find(GetParam()).create({start, SolveMode::batch}, exactly());
    for (std::size_t k = 0; k < log.size(); ++k) {
      if (k > 0) estimator->add_keyframe(log.arrival(k).step);
      give(*estimator, log.arrival(k));
    }
    EXPECT_TRUE(is_done(estimator->finish(connected_guess(log)).outcome));
    const std::vector<Pose> truth = circle(log.size(), options.start.pose);
    const NaiveLeastSquares expected = least_squares(log, 20, truth);
    EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-6);
    EXPECT_LT((*estimator->covariance(0) - expected.marginal(0)).norm(),
              1e-4 * expected.marginal(0).norm());
  }
}

}  // namespace
}  // namespace fathom::test
