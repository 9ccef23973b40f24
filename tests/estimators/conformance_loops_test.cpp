// Of the conformance suite: loops written either way round, gates and losses.

#include <functional>

#include "tests/estimators/conformance.hpp"

namespace fathom::test {
namespace {

// `turns` says of each registration, in their order, whether it is written the other way round.
MeasurementLog rewritten(const MeasurementLog& log,
                         const std::function<bool(std::size_t index)>& turns) {
  MeasurementLog result(log.origin());
  std::size_t index = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    result.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) {
      result.add_registration(turns(index++) ? z.reversed() : z);
    }
  }
  return result;
}

// All of them, and single ones of a set; without a loss and with each that the estimator has.
TEST_P(Conformance, TheWayALoopIsWrittenMakesNoDifferenceToFirstOrder) {
  LogOptions options;
  options.noise = 0.01;
  const MeasurementLog log = circle_log(options);
  const MeasurementLog all = rewritten(log, [](std::size_t) { return true; });
  const MeasurementLog single = rewritten(log, [](std::size_t index) { return index % 2 == 1; });
  for (const std::string& loss : losses()) {
    const EstimatorValues options_of_loss =
        loss == "none" ? EstimatorValues{} : values({{"loss", loss}});
    const std::vector<Pose> poses = poses_of(*solved(GetParam(), log, options_of_loss));
    // Second order in a noise of 3e-4 m and 2e-4 rad.
    EXPECT_LT(largest_distance(poses_of(*solved(GetParam(), all, options_of_loss)), poses), 1e-6);
    EXPECT_LT(largest_distance(poses_of(*solved(GetParam(), single, options_of_loss)), poses),
              1e-6);
  }
}

// False loops that bear each other out, in one set and in the next, either direction among them.
TEST_P(Conformance, ALossJudgesFalseLoopsWhateverWayRoundTheyAreWritten) {
  const MeasurementLog log = with_a_false_place(60);
  const MeasurementLog mixed = rewritten(log, [](std::size_t index) { return index % 2 == 1; });
  for (const std::string& loss : losses()) {
    // huber follows them, and what is far off is not the same the other way round to first order.
    if (loss == "none" || loss == "huber") continue;
    const auto weights = [&](const MeasurementLog& of) {
      return solved(GetParam(), of, values({{"loss", loss}}))->loop_weights();
    };
    const std::vector<double> straight = weights(log);
    const std::vector<double> turned = weights(mixed);
    ASSERT_EQ(turned.size(), straight.size());
    for (std::size_t j = 0; j < turned.size(); ++j) {
      EXPECT_NEAR(turned[j], straight[j], 0.05) << loss << ", registration " << j;
    }
  }
}

TEST_P(Conformance, TheGateRefusesAWrongLoopAndSaysSo) {
  LogOptions options;
  MeasurementLog log = circle_log(options);
  const RelativePose last = log.arrival(log.size() - 1).step;
  const std::size_t k = log.size();
  log.add_keyframe(RelativePose::from_covariance(k - 1, k, last.motion, last.covariance()));
  const auto without = solved(GetParam(), log);
  const Pose right = between(without->pose(10), without->pose(k));
  log.add_registration(RelativePose::from_covariance(
      10, k, {right.x + 5.0, right.y - 3.0, wrap_angle(right.theta + 1.0)},
      full_covariance(0.01, 0.005)));

  const auto gated = make({}, values({{"gate_probability", "0.9999"}}));
  std::vector<LoopDecision> decisions;
  EXPECT_TRUE(is_done(feed(*gated, log, &decisions)));
  ASSERT_EQ(decisions.size(), log.registration_count());
  for (const LoopDecision& decision : decisions) {
    EXPECT_EQ(decision.fate == LoopFate::used, decision.to != k)
        << decision.from << " to " << decision.to;
    ASSERT_TRUE(decision.nis);
  }
  EXPECT_GT(*decisions.back().nis, 100.0);

  // Without the gate the same loop is taken, and ruins the estimate.
  const auto open = make();
  feed(*open, log);
  EXPECT_LT(largest_distance(poses_of(*gated), poses_of(*without)), 1e-9);
  EXPECT_GT(largest_distance(poses_of(*open), poses_of(*without)), 0.5);
}

TEST_P(Conformance, TheGateKeepsItsShareOfRightLoops) {
  std::size_t accepted = 0;
  std::size_t all = 0;
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    // One loop each, over a short way: the innovation is as Gaussian as its noise.
    RandomStream random(seed, "gate");
    MeasurementLog log;
    for (std::size_t k = 1; k <= 5; ++k) {
      log.add_keyframe(
          RelativePose::from_covariance(k - 1, k, perturbed({1.0, 0.0, 0.3}, 0.01, 0.005, random),
                                        Eigen::Vector3d(1e-4, 1e-4, 2.5e-5).asDiagonal()));
    }
    Pose truth;
    for (int k = 0; k < 5; ++k) truth = compose(truth, {1.0, 0.0, 0.3});
    log.add_registration(
        RelativePose::from_covariance(0, 5, perturbed(truth, 0.01, 0.005, random),
                                      Eigen::Vector3d(1e-4, 1e-4, 2.5e-5).asDiagonal()));
    const auto estimator = make({}, values({{"gate_probability", "0.5"}}));
    std::vector<LoopDecision> decisions;
    feed(*estimator, log, &decisions);
    ++all;
    if (decisions.front().fate == LoopFate::used) ++accepted;
  }
  // Binomial(40, 0.5): outside 10 … 30 once in a thousand.
  EXPECT_GE(accepted, 10U);
  EXPECT_LE(accepted, 30U);
}

}  // namespace
}  // namespace fathom::test
