// What loops weigh in incremental_smoother while others arrive: weights fall and come back, and an
// update that fails leaves them as they were.

#include <cmath>

#include <gtest/gtest.h>

#include "estimators/incremental_smoother/incremental_smoother.hpp"
#include "estimators/incremental_smoother/smoother.hpp"
#include "fathom/measurements/spoil.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/estimators/smoother_logs.hpp"

namespace fathom {
namespace {

using test::arrive;
using test::make;

// Two rounds of a circle. Two loops that agree with each other and are both wrong by more than a
// metre come first, with keyframe 34 and 35; from keyframe 36 on all are right.
MeasurementLog wrong_then_right() {
  const std::vector<Pose> truth = test::circle(60);
  RandomStream random(5, "wrong then right");
  MeasurementLog log;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    log.add_keyframe(
        test::measured(truth, k - 1, k, test::kStepSigmaM, test::kStepSigmaRad, random));
    if (k < 34) continue;
    RelativePose loop = test::measured(truth, k - 30, k, 0.02, 0.01, random);
    if (k < 36) loop.motion = compose(Pose{1.2, -0.8, 0.0}, loop.motion);
    log.add_registration(loop);
  }
  return log;
}

TEST(IncrementalWeights, FallAndComeBackAsOtherLoopsArrive) {
  const MeasurementLog log = wrong_then_right();
  const auto ours = make("incremental_smoother", log.origin(), test::exactly_with("cauchy"));
  const auto whole = make("sparse_gauss_newton", log.origin(), test::exactly_with("cauchy"));
  std::vector<double> at_first;
  std::vector<double> while_alone;
  for (std::size_t k = 1; k < log.size(); ++k) {
    arrive(*ours, log, k);
    arrive(*whole, log, k);
    if (k == 35) at_first = ours->loop_weights();
    if (k == 38) while_alone = ours->loop_weights();
    const std::vector<double> expected = whole->loop_weights();
    ASSERT_EQ(ours->loop_weights().size(), expected.size());
    for (std::size_t j = 0; j < expected.size(); ++j) {
      ASSERT_NEAR(ours->loop_weights()[j], expected[j], 1e-4) << k << ", " << j;
    }
  }
  const std::vector<double> at_last = ours->loop_weights();
  for (const std::size_t wrong : {0, 1}) {
    EXPECT_GT(at_first[wrong], 0.5);
    EXPECT_LT(at_last[wrong], 0.01);
  }
  for (const std::size_t right : {2, 3, 4}) {
    EXPECT_LT(while_alone[right], 0.01);
    EXPECT_GT(at_last[right], 0.9);
  }
}

// Of geman_mcclure such a loop weighs nothing.
TEST(IncrementalWeights, AnUpdateThatFailsLeavesThemAsTheyWere) {
  const MeasurementLog log = wrong_then_right();
  for (const char* loss : {"huber", "cauchy", "dcs"}) {
    const auto ours = make("incremental_smoother", log.origin(), test::exactly_with(loss));
    const auto undisturbed = make("incremental_smoother", log.origin(), test::exactly_with(loss));
    std::size_t failed = 0;
    for (std::size_t k = 1; k < log.size(); ++k) {
      arrive(*ours, log, k);
      arrive(*undisturbed, log, k);
      if (k % 9 != 2) continue;
      const std::vector<Pose> poses = poses_of(*ours);
      const std::vector<double> weights = ours->loop_weights();
      // Three at once, with one of which the matrix is not positive definite.
      const Eigen::Matrix3d information = 1e4 * Eigen::Matrix3d::Identity();
      const std::vector<RelativePose> bad{{0, k, {}, information, {}},
                                          {1, k, {}, information, {}},
                                          {2, k, {}, -1e4 * information, {}}};
      const UpdateReport report = ours->update({bad});
      ASSERT_EQ(report.outcome, Outcome::numerical_failure) << loss << k;
      EXPECT_EQ(report.loops.front().fate, LoopFate::lost);
      EXPECT_LT(test::largest_distance(poses_of(*ours), poses), 1e-12);
      const std::vector<double> after = ours->loop_weights();
      ++failed;
      ASSERT_EQ(after.size(), weights.size() + bad.size());
      for (std::size_t j = 0; j < weights.size(); ++j) ASSERT_NEAR(after[j], weights[j], 1e-9);
      for (std::size_t j = weights.size(); j < after.size(); ++j) EXPECT_EQ(after[j], 0.0);
    }
    EXPECT_GT(failed, 5U);
    EXPECT_LT(test::largest_distance(poses_of(*ours), poses_of(*undisturbed)), 1e-5) << loss;
  }
}

TEST(IncrementalWeights, RepeatToTheLastBit) {
  const MeasurementLog log =
      spoil(test::wandering_log(200, 4), test::wandering_log(200, 4).odometry(), {.share = 0.2}, 5)
          .log;
  for (const char* loss : {"huber", "cauchy", "geman_mcclure", "dcs"}) {
    const EstimatorValues values = test::values({{"loss", loss}});
    const auto once = test::solved("incremental_smoother", log, values);
    const auto again = test::solved("incremental_smoother", log, values);
    EXPECT_EQ(poses_of(*once), poses_of(*again)) << loss;
    EXPECT_EQ(once->loop_weights(), again->loop_weights()) << loss;
  }
}

// Every loop counts in them with its weight, as in the other graphs.
TEST(IncrementalWeights, AreInTheCovariances) {
  const MeasurementLog log = wrong_then_right();
  const auto ours = test::solved("incremental_smoother", log, test::exactly_with("cauchy"));
  const auto whole = test::solved("sparse_gauss_newton", log, test::exactly_with("cauchy"));
  const auto plain = test::solved("incremental_smoother", log, test::exactly());
  const std::size_t last = log.size() - 1;
  const std::vector<std::size_t> keyframes{3, 35, last};
  const Eigen::MatrixXd joint = *whole->joint_covariance(keyframes);
  EXPECT_LT((*ours->joint_covariance(keyframes) - joint).norm(), 1e-4 * joint.norm());
  EXPECT_GT((*plain->joint_covariance(keyframes) - joint).norm(), 1e-2 * joint.norm());
  const Eigen::Matrix3d of_last = *whole->covariance(last);
  EXPECT_LT((*ours->covariance(last) - of_last).norm(), 1e-4 * of_last.norm());
  const Eigen::Matrix3d motion = ours->motions_to_newest()->front().covariance;
  EXPECT_LT((motion - of_last).norm(), 1e-4 * of_last.norm());
  // That of the tree, where a weight may be off by a tenth.
  EXPECT_LT((*ours->newest_covariance() - of_last).norm(), 0.1 * of_last.norm());
}

TEST(IncrementalWeights, AreInTheGate) {
  const MeasurementLog log = wrong_then_right();
  EstimatorValues values = test::exactly_with("cauchy");
  values["gate_probability"] = OptionValue::scalar("0.999999999");
  const auto ours = make("incremental_smoother", log.origin(), values);
  const auto whole = make("sparse_gauss_newton", log.origin(), values);
  std::size_t judged = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const UpdateReport report = arrive(*ours, log, k);
    const UpdateReport expected = arrive(*whole, log, k);
    for (std::size_t j = 0; j < report.loops.size(); ++j) {
      EXPECT_EQ(report.loops[j].fate, expected.loops[j].fate);
      EXPECT_NEAR(*report.loops[j].nis, *expected.loops[j].nis, 0.1 * *expected.loops[j].nis);
      ++judged;
    }
  }
  EXPECT_GT(judged, 20U);
}

// Where steps fail or contract slowly, Newton's steps of the whole graph find the same minimum.
TEST(IncrementalWeights, TheWholeGraphIsSolvedWithTheLoss) {
  const MeasurementLog plain = test::wandering_log(120, 2);
  const MeasurementLog log = spoil(plain, plain.odometry(), {.share = 0.2}, 2).log;
  const auto ours = test::solved("incremental_smoother", log, test::exactly_with("huber"));
  const auto whole = test::solved("sparse_gauss_newton", log, test::exactly_with("huber"));
  const auto& smoother = dynamic_cast<const IncrementalSmoother&>(
                             dynamic_cast<const AnchoredEstimator&>(*ours).relative())
                             .smoother();
  EXPECT_GT(smoother.counts().batch_solves, 0);
  EXPECT_LT(test::largest_distance(poses_of(*ours), poses_of(*whole)), 1e-5);
}

TEST(IncrementalWeights, RefusesWhatWouldHaveNoEffect) {
  const auto refuses = [](const EstimatorValues& values) {
    EXPECT_THROW(make("incremental_smoother", StartPose{}, values), InputError);
  };
  refuses(test::values({{"loss", "truncated"}}));
  refuses(test::values({{"loss_scale", "2"}}));
  EXPECT_TRUE(make("incremental_smoother", StartPose{})->loop_weights().empty());
  EXPECT_EQ(make("incremental_smoother", StartPose{})->loss(30.0), 30.0);
}

}  // namespace
}  // namespace fathom
