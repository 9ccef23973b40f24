// trajectory_iekf in every form of its covariance: the same to rounding, gated and lost updates
// too.

#include <algorithm>
#include <cmath>
#include <set>

#include <gtest/gtest.h>

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive_filters.hpp"

namespace fathom {
namespace {

using test::largest_distance;
using test::largest_turn;
using test::LogOptions;

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

// Dead reckoning of `plain`, with loops of keyframe k from those that `froms_of(k)` names.
template <class FromsOf>
MeasurementLog with_loops(const LogOptions& plain, RandomStream& random, const FromsOf& froms_of) {
  const MeasurementLog log = test::circle_log(plain);
  const std::vector<Pose> truth = test::circle(plain.keyframes, plain.origin);
  MeasurementLog result(log.origin());
  for (std::size_t k = 1; k < log.size(); ++k) {
    result.add_keyframe(log.arrival(k).step);
    for (const std::size_t from : froms_of(k)) {
      const Pose z = test::perturbed(between(truth[from], truth[k]), test::kLoopSigmaM,
                                     test::kLoopSigmaRad, random);
      result.add_registration(RelativePose::from_covariance(
          from, k, z, test::full_covariance(test::kLoopSigmaM, test::kLoopSigmaRad)));
    }
  }
  return result;
}

// A circuit with few loops until it is closed at its end: the first two motions are dense early,
// the loops that end it begin with these and with motions that are not.
MeasurementLog closed_at_its_end() {
  LogOptions plain;
  plain.keyframes = 30;
  plain.loop_every = 0;
  plain.noise = 2.0;
  RandomStream random(9, "loops");
  return with_loops(plain, random, [](std::size_t k) -> std::vector<std::size_t> {
    if (k >= 24) return {0, 1, k - 2};
    if (k == 2 || (k > 0 && k % 5 == 0)) return {k - 2};
    return {};
  });
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
  const MeasurementLog late = closed_at_its_end();
  for (const FormCase& test : form_cases()) {
    for (const MeasurementLog* log : {&rounds, &mixed, &late}) {
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

// Loops of any number and reach, seldom and often.
MeasurementLog any_loops(std::uint64_t seed) {
  LogOptions plain;
  plain.keyframes = 30;
  plain.loop_every = 0;
  plain.seed = seed;
  RandomStream random(seed, "any loops");
  const double how_often = random.uniform(0.05, 0.7);
  return with_loops(plain, random, [&](std::size_t k) {
    std::set<std::size_t> froms;
    if (random.uniform() > how_often) return froms;
    const std::size_t count = std::min<std::size_t>(1 + random.index(4), k);
    while (froms.size() < count) {
      const bool local = random.uniform() < 0.5;
      froms.insert(local ? k - 1 - random.index(std::min<std::size_t>(k, 4)) : random.index(k));
    }
    return froms;
  });
}

TEST(TrajectoryIekf, WithAnyLoopsEqualsTheTextbookFilter) {
  TrajectoryIekfOptions options;
  options.max_iterations = 3;
  options.tolerance = 1e-300;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const MeasurementLog log = any_loops(seed);
    TrajectoryIekf filter({log.origin()}, options);
    test::feed(filter, log);
    const std::vector<Pose> reference = test::run_naive(test::NaiveTrajectoryIekf(log, 3), log);
    EXPECT_LT(largest_distance(poses_of(filter), reference), 1e-6) << "seed " << seed;
    EXPECT_LT(largest_turn(poses_of(filter), reference), 1e-6) << "seed " << seed;
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
