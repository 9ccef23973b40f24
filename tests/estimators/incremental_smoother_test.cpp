// incremental_smoother against sparse_gauss_newton, which solves the whole graph at every update.

#include "estimators/incremental_smoother/incremental_smoother.hpp"

#include <array>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "estimators/incremental_smoother/smoother.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/smoother_logs.hpp"

namespace fathom {
namespace {

using test::arrive;
using test::LogOptions;
using test::make;
using test::tracks_log;
using test::wandering_log;

const incremental_smoother::Counts& counts_of(const Estimator& estimator) {
  return dynamic_cast<const IncrementalSmoother&>(
             dynamic_cast<const AnchoredEstimator&>(estimator).relative())
      .smoother()
      .counts();
}

std::vector<MeasurementLog> logs() {
  std::vector<MeasurementLog> all;
  for (const double noise : {1.0, 4.0}) {
    LogOptions options;
    options.keyframes = 60;
    options.noise = noise;
    options.origin = {3.0, -7.0, 3.0};
    all.push_back(test::circle_log(options));
    options.loop_every = 1;
    all.push_back(test::circle_log(options));
  }
  for (const std::uint64_t seed : {1, 2, 3}) all.push_back(wandering_log(150, seed));
  all.push_back(tracks_log(240, 20));
  return all;
}

TEST(IncrementalSmoother, IsAtTheOptimumAfterEveryUpdate) {
  const EstimatorValues exactly = test::values({{"tolerance", "1e-13"}});
  std::size_t compared = 0;
  for (const MeasurementLog& log : logs()) {
    const auto ours = make("incremental_smoother", log.origin(), exactly);
    const auto whole = make("sparse_gauss_newton", log.origin(), exactly);
    for (std::size_t k = 1; k < log.size(); ++k) {
      ASSERT_EQ(arrive(*ours, log, k).outcome, Outcome::converged) << k;
      arrive(*whole, log, k);
      ASSERT_LT(test::largest_distance(poses_of(*ours), poses_of(*whole)), 1e-6) << k;
      ASSERT_LT(test::largest_turn(poses_of(*ours), poses_of(*whole)), 1e-6) << k;
      ++compared;
    }
  }
  EXPECT_GT(compared, 800U);
}

TEST(IncrementalSmoother, StaysWithinAFewThousandthsOfTheOptimumByDefault) {
  for (const MeasurementLog& log : logs()) {
    const auto ours = make("incremental_smoother", log.origin());
    const auto whole = make("sparse_gauss_newton", log.origin());
    MeasurementLog so_far(log.origin());
    for (std::size_t k = 1; k < log.size(); ++k) {
      arrive(*ours, log, k);
      arrive(*whole, log, k);
      so_far.add_keyframe(log.arrival(k).step);
      for (const RelativePose& z : log.arrival(k).registrations) so_far.add_registration(z);
      if (k % 10 != 0 && k + 1 != log.size()) continue;
      const double optimum = chi2(so_far, poses_of(*whole));
      EXPECT_LT(chi2(so_far, poses_of(*ours)), 1.003 * optimum + 1e-6) << k;
    }
  }
}

TEST(IncrementalSmoother, HasTheCovariancesOfTheWholeGraph) {
  const EstimatorValues exactly = test::values({{"tolerance", "1e-13"}});
  const MeasurementLog log = wandering_log(80, 7);
  const auto ours = make("incremental_smoother", log.origin(), exactly);
  const auto whole = make("sparse_gauss_newton", log.origin(), exactly);
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*ours, log, k);
    arrive(*whole, log, k);
    if (k % 20 != 0) continue;
    for (std::size_t j = 1; j <= k; ++j) {
      const Eigen::Matrix3d C = *whole->covariance(j);
      EXPECT_LT((*ours->covariance(j) - C).norm(), 1e-6 * C.norm());
    }
  }
}

TEST(IncrementalSmoother, JudgesLoopsAsTheWholeGraphDoes) {
  const EstimatorValues gated = test::values({{"gate_probability", "0.999999999"}});
  for (const MeasurementLog& log : {wandering_log(150, 5), test::circle_log({})}) {
    const auto ours = make("incremental_smoother", log.origin(), gated);
    const auto whole = make("sparse_gauss_newton", log.origin(), gated);
    std::vector<LoopDecision> our_loops;
    std::vector<LoopDecision> their_loops;
    test::feed(*ours, log, &our_loops);
    test::feed(*whole, log, &their_loops);
    ASSERT_EQ(our_loops.size(), log.registration_count());
    for (std::size_t j = 0; j < our_loops.size(); ++j) {
      EXPECT_EQ(our_loops[j].fate, their_loops[j].fate);
      EXPECT_NEAR(*our_loops[j].nis, *their_loops[j].nis, 0.02 * *their_loops[j].nis + 0.01) << j;
    }
  }
}

// An update is as much work as the loop is long, not as the map is large.
TEST(IncrementalSmoother, EliminatesLittleAgainForALocalLoop) {
  const MeasurementLog log = tracks_log(6000, 20);
  const auto estimator = make("incremental_smoother", log.origin());
  std::vector<double> eliminated_per_update;
  long before = 0;
  int updates = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*estimator, log, k);
    updates += log.arrival(k).registrations.empty() ? 0 : 1;
    if (k % 1500 != 1499) continue;
    const long now = counts_of(*estimator).eliminated;
    eliminated_per_update.push_back(static_cast<double>(now - before) / updates);
    before = now;
    updates = 0;
  }
  ASSERT_EQ(eliminated_per_update.size(), 4U);
  // Of up to 6000 keyframes.
  EXPECT_LT(eliminated_per_update.back(), 250.0);
  EXPECT_LT(eliminated_per_update.back(), 3.0 * eliminated_per_update.front());
  EXPECT_LE(counts_of(*estimator).batch_solves, 1);  // by chance (MinimumSearch)
}

TEST(IncrementalSmoother, AnUpdateThatFailsIsForgotten) {
  const MeasurementLog log = wandering_log(60, 9);
  const EstimatorValues exactly = test::values({{"tolerance", "1e-13"}});
  const auto ours = make("incremental_smoother", log.origin(), exactly);
  const auto whole = make("sparse_gauss_newton", log.origin(), exactly);
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*ours, log, k);
    arrive(*whole, log, k);
    if (k % 15 != 0) continue;
    const std::vector<Pose> before = poses_of(*ours);
    const std::vector<RelativePose> far{{2, k, {1e200, 0.0, 0.0}, Eigen::Matrix3d::Identity(), {}}};
    const UpdateReport report = ours->update({far});
    EXPECT_EQ(report.outcome, Outcome::numerical_failure);
    EXPECT_EQ(report.loops.front().fate, LoopFate::lost);
    EXPECT_EQ(poses_of(*ours), before);
  }
  EXPECT_LT(test::largest_distance(poses_of(*ours), poses_of(*whole)), 1e-6);
}

TEST(IncrementalSmoother, StopsAtItsLimitAndGoesOnWithTheNextUpdate) {
  LogOptions options;
  options.noise = 4.0;
  const MeasurementLog log = test::circle_log(options);
  const auto hasty = make("incremental_smoother", log.origin(),
                          test::values({{"max_iterations", "1"}, {"tolerance", "1e-12"}}));
  std::vector<LoopDecision> loops;
  EXPECT_EQ(test::feed(*hasty, log, &loops), Outcome::iteration_limit);
  const auto whole = test::solved("sparse_gauss_newton", log);
  const double optimum = chi2(log, poses_of(*whole));
  EXPECT_LT(chi2(log, poses_of(*hasty)), 1.1 * optimum);
}

// Noise so large that steps raise the cost, however they are taken.
TEST(IncrementalSmoother, SolvesTheWholeGraphWhereItsStepsFail) {
  LogOptions options;
  options.keyframes = 60;
  options.noise = 24.0;
  const MeasurementLog log = test::circle_log(options);
  const EstimatorValues exactly = test::values({{"tolerance", "1e-13"}});
  const auto ours = test::solved("incremental_smoother", log, exactly);
  const auto whole = test::solved("sparse_gauss_newton", log, exactly);
  EXPECT_GT(counts_of(*ours).batch_solves, 0);
  EXPECT_LT(chi2(log, poses_of(*ours)), (1.0 + 1e-8) * chi2(log, poses_of(*whole)));
}

// Once or twice round a rectangle, and on along its first side, with a heading that is lost where
// the loops begin.
MeasurementLog drifted_circuit(const std::vector<int>& legs, std::size_t around, int every,
                               std::uint64_t seed) {
  RandomStream random(seed, "drifted circuit");
  std::vector<Pose> truth{{0.0, 0.0, 0.0}};
  for (const int steps : legs) {
    for (int i = 0; i < steps; ++i) {
      const double turn = i == 0 && truth.size() > 1 ? M_PI / 2 : 0.0;
      truth.push_back(compose(compose(truth.back(), {0.0, 0.0, turn}), {0.5, 0.0, 0.0}));
    }
  }
  MeasurementLog log(truth[0]);
  for (std::size_t k = 1; k < truth.size(); ++k) {
    log.add_keyframe(test::measured(truth, k - 1, k, 0.01, 0.08, random));
    if (k > around + 2 && k % static_cast<std::size_t>(every) == 0) {
      log.add_registration(test::measured(truth, k - around, k, 0.005, 0.003, random));
    }
  }
  return log;
}

// Without the search for a lower minimum some of these end at up to twenty times the least F.
TEST(IncrementalSmoother, IsAtTheLeastCostWhereTheHeadingWasLost) {
  long batch_solves = 0;
  int logs = 0;
  for (const auto& [legs, around] : std::vector<std::pair<std::vector<int>, std::size_t>>{
           {{60, 20, 60, 20, 15}, 160},
           {{80, 40, 80, 40, 10}, 240},
           {{40, 40, 40, 40, 40, 40, 40, 40, 10}, 160}}) {
    for (std::uint64_t seed = 1; seed <= 60; ++seed) {
      const int every = std::array{4, 10, 1}[seed % 3];
      const MeasurementLog log = drifted_circuit(legs, around, every, seed);
      const auto ours = test::solved("incremental_smoother", log);
      const auto whole = test::solved("sparse_gauss_newton", log);
      const double least = chi2(log, poses_of(*whole));
      EXPECT_LT(chi2(log, poses_of(*ours)), 1.01 * least) << seed;
      batch_solves += counts_of(*ours).batch_solves;
      ++logs;
    }
  }
  EXPECT_LT(batch_solves, 3 * logs);
}

// Of a loop that the sums of the tree do not carry there is no tree, and the gate asks the graph.
TEST(IncrementalSmoother, GatesAfterALoopBeyondItsTree) {
  const MeasurementLog log = test::with_precise_loop(7, 1e20);
  const EstimatorValues gate = test::values({{"gate_probability", "0.9999"}});
  const auto ours = make("incremental_smoother", log.origin(), gate);
  const auto whole = make("sparse_gauss_newton", log.origin(), gate);
  std::vector<LoopDecision> loops;
  std::vector<LoopDecision> expected;
  EXPECT_EQ(test::feed(*ours, log, &loops), Outcome::converged);
  EXPECT_EQ(test::feed(*whole, log, &expected), Outcome::converged);
  ASSERT_EQ(loops.size(), expected.size());
  for (std::size_t j = 0; j < loops.size(); ++j) {
    EXPECT_EQ(loops[j].fate, LoopFate::used) << j;
    EXPECT_NEAR(*loops[j].nis, *expected[j].nis, 1e-3 * *expected[j].nis) << j;
  }
  EXPECT_LT(test::largest_distance(poses_of(*ours), poses_of(*whole)), 1e-5);
}

}  // namespace
}  // namespace fathom
