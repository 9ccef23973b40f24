// Absolute measurements and holes through replay, judgement, record and files.

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/harness/map_fit.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/harness/run_record.hpp"
#include "harness/square_result.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using nlohmann::json;
using test::evaluated;
using testing::ElementsAre;

// The square with an exact fix of every other keyframe, but of keyframe 6 one that is 20 m off, and
// with a compass on keyframe 0, whose pose is uncertain.
Recording recording(bool with_hole = false) {
  Recording result = test::square();
  const MeasurementLog plain = result.log;
  const std::vector<Pose> truth = test::square_truth();
  StartPose start(truth[0]);
  start.covariance = 1e-4 * Eigen::Matrix3d::Identity();
  result.log = MeasurementLog(start);
  for (std::size_t k = 0; k < plain.size(); ++k) {
    if (k > 0) {
      RelativePose step = plain.arrival(k).step;
      step.is_hole = with_hole && k == 4;
      if (step.is_hole) step.information = 1e-4 * Eigen::Matrix3d::Identity();
      result.log.add_keyframe(step);
    }
    for (const RelativePose& z : plain.arrival(k).registrations) result.log.add_registration(z);
    if (k == 0) result.log.add_absolute(AbsolutePose::heading(0, truth[0].theta, 0.1));
    if (k % 2 == 1) continue;
    const Eigen::Vector2d off(k == 6 ? 20.0 : 0.0, 0.0);
    result.log.add_absolute(
        AbsolutePose::position(k, truth[k].position() + off, 1e-2 * Eigen::Matrix2d::Identity()));
  }
  return result;
}

const EstimatorValues kGate{{"gate_probability", OptionValue::scalar("0.99")}};

TEST(AbsoluteResult, CountsWhatIsUsedAndRejected) {
  const Recording jump = recording();
  const Result result = evaluated(jump, "ekf", kGate);
  EXPECT_EQ(result.metric("absolute_measurements"), 5.0);
  EXPECT_EQ(result.metric("absolute_used"), 4.0);
  EXPECT_EQ(result.metric("absolute_rejected"), 1.0);
  EXPECT_EQ(result.metric("updates"), 6.0);
}

TEST(AbsoluteResult, PartsOfTheCostAddUp) {
  const Recording jump = recording();
  const Result result = evaluated(jump, "ekf", kGate);
  const std::vector<Pose>& at = result.run.trajectory;
  double edges = 0.0;
  for (const RelativePose& z : jump.log.edges()) edges += chi2(z, at[z.from], at[z.to]);
  double absolute = chi2(jump.log.start().measurement(), at[0]);
  for (std::size_t k = 0; k < jump.log.size(); ++k) {
    for (const AbsolutePose& z : jump.log.arrival(k).absolute) absolute += chi2(z, at[k]);
  }
  const double rejected = chi2(jump.log.arrival(6).absolute[0], at[6]);
  EXPECT_GT(rejected, 1e4);
  EXPECT_NEAR(*result.metric("absolute_chi2"), absolute, 1e-9 * absolute);
  EXPECT_NEAR(*result.metric("chi2"), edges + absolute, 1e-9 * absolute);
  EXPECT_NEAR(*result.metric("absolute_chi2_used"), absolute - rejected, 1e-9 * absolute);
  EXPECT_NEAR(*result.metric("chi2_used"), edges + absolute - rejected, 1e-9 * absolute);
}

TEST(AbsoluteResult, IsWrittenAndStored) {
  const Recording jump = recording();
  const Result result = evaluated(jump, "ekf", kGate);
  const json written = json::parse(metrics_json(result, jump));
  test::expect_no_null(written, "metrics");
  ASSERT_EQ(written.at("rejected_absolute").size(), 1U);
  EXPECT_EQ(written.at("rejected_absolute")[0].at("keyframe"), 6);
  const RunRecord run = run_record(jump, result, "hash");
  EXPECT_THAT(run.series.at("absolute_keyframe"), ElementsAre(0, 0, 2, 4, 6));
  EXPECT_THAT(run.series.at("absolute_fate"), ElementsAre(0, 0, 0, 0, 1));
  EXPECT_THAT(run.series.at("absolute_weight"), ElementsAre(1, 1, 1, 1, 0));
  EXPECT_EQ(run.series.at("update_keyframe").size(), run.series.at("update_ms").size());
  EXPECT_THAT(run.series.at("update_keyframe"), ElementsAre(0, 2, 4, 5, 6, 7));
  const test::TemporaryFolder folder;
  write_run(folder.path(), jump, result, "{}");
  const std::string csv = read_file(folder / "absolute.csv");
  EXPECT_EQ(csv.find("keyframe,fate,nis,rank,weight\n0,used,"), 0U) << csv;
  EXPECT_NE(csv.find("\n6,rejected,"), std::string::npos) << csv;
  // Without any nothing of it is there.
  const Recording plain = test::square();
  const Result without = evaluated(plain);
  EXPECT_FALSE(json::parse(metrics_json(without, plain)).contains("rejected_absolute"));
  EXPECT_FALSE(run_record(plain, without, "").series.contains("absolute_fate"));
  const test::TemporaryFolder other;
  write_run(other.path(), plain, without, "{}");
  EXPECT_FALSE(std::filesystem::exists(other / "absolute.csv"));
}

// The world of the measurements lies anywhere in the frame of the ground truth: what is stored is
// in the latter, where the stored estimate is.
TEST(AbsoluteResult, WhatWasMeasuredIsStoredInTheFrameOfTheAlignedEstimate) {
  Recording jump = recording();
  const Pose motion{40.0, -7.0, 2.0};
  std::vector<Pose> truth;
  for (const Pose& pose : test::square_truth()) truth.push_back(compose(motion, pose));
  jump.ground_truth = truth;
  JudgeOptions judging;
  judging.metrics.alignment = Alignment::se2;
  const Result result = evaluate(jump, {"ekf", "ekf", kGate}, builtin_estimators(), judging, {});
  const RunRecord run = run_record(jump, result, "hash");
  const auto at = [&run](const char* name, std::size_t i) { return run.series.at(name).at(i); };
  // A heading of keyframe 0, then fixes of 0, 2, 4 and 6.
  EXPECT_TRUE(std::isnan(at("absolute_x_m", 0)));
  EXPECT_TRUE(std::isnan(at("absolute_cov_yy", 0)));
  EXPECT_NEAR(wrap_angle(at("absolute_theta_rad", 0) - truth[0].theta), 0.0, 0.05);
  EXPECT_NEAR(at("absolute_sigma_rad", 0), 0.1, 1e-12);
  for (std::size_t i = 1; i < 5; ++i) {
    EXPECT_TRUE(std::isnan(at("absolute_theta_rad", i)));
    EXPECT_TRUE(std::isnan(at("absolute_sigma_rad", i)));
    const std::size_t k = 2 * (i - 1);
    const Eigen::Vector2d fix(at("absolute_x_m", i), at("absolute_y_m", i));
    const Eigen::Vector2d off = rotation(motion.theta) * Eigen::Vector2d(k == 6 ? 20.0 : 0.0, 0.0);
    // The alignment is that of an estimate with errors of a centimetre over 1 m.
    EXPECT_LT((fix - off - truth[k].position()).norm(), k == 6 ? 0.6 : 0.1) << k;
    EXPECT_NEAR(at("absolute_cov_xx", i), 1e-2, 1e-9);
    EXPECT_NEAR(at("absolute_cov_xy", i), 0.0, 1e-9);
    // As far from the estimate as it was.
    const Eigen::Vector2d estimate(at("x_m", k), at("y_m", k));
    const double residual_m =
        (jump.log.arrival(k).absolute.back().pose.position() - result.run.trajectory[k].position())
            .norm();
    EXPECT_NEAR((fix - estimate).norm(), residual_m, 1e-9) << k;
  }
}

// Nothing is stored of what was not measured at all.
TEST(AbsoluteResult, ACompassAloneHasNoPositions) {
  Recording compass = test::square();
  compass.log.add_absolute(AbsolutePose::heading(7, 1.0, 0.1));
  const RunRecord run = run_record(compass, evaluated(compass), "hash");
  EXPECT_FALSE(run.series.contains("absolute_x_m"));
  EXPECT_FALSE(run.series.contains("absolute_cov_xx"));
  EXPECT_THAT(run.series.at("absolute_theta_rad"), ElementsAre(testing::DoubleNear(1.0, 1e-9)));
}

TEST(AbsoluteResult, HolesAreCountedAndCostNothing) {
  const Recording holed = recording(true);
  const Result result = evaluated(holed, "ekf", kGate);
  EXPECT_EQ(result.metric("holes"), 1.0);
  EXPECT_EQ(result.metric("degrees_of_freedom"), 3.0 * 4 + (1 + 4 * 2) - 3.0);
  EXPECT_FALSE(evaluated(recording(), "ekf").metric("holes"));
}

// Of steps at the optimum without the hole; of unknowns with keyframe 0.
TEST(AbsoluteResult, AMapsFitCountsThem) {
  const MeasurementLog log = recording(true).log;
  const auto optimum = batch_optimum(log, builtin_estimators());
  ASSERT_TRUE(optimum);
  const auto fit = map_fit(log, optimum->poses, *optimum);
  ASSERT_TRUE(fit);
  EXPECT_EQ(fit->degrees_of_freedom, 18.0);
  EXPECT_EQ(fit->unknowns, 24.0);
  double steps = 0.0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    if (k == 4) continue;
    steps += chi2(log.arrival(k).step, optimum->poses[k - 1], optimum->poses[k]);
  }
  EXPECT_NEAR(fit->steps_at_optimum, steps, 1e-12 * steps);
  EXPECT_NEAR(fit->absolute_at_optimum, absolute_chi2(log, optimum->poses), 1e-12);
  // The jump of 20 m is most of F.
  const std::vector<std::string> remarks = map_remarks(*fit, "ekf", "solver");
  ASSERT_EQ(remarks.size(), 1U);
  EXPECT_THAT(remarks[0], testing::HasSubstr("% of F is of absolute measurements"));
}

// Dead reckoning from an uncertain start is as uncertain as the start is.
TEST(AbsoluteResult, DeadReckoningBeginsWithTheStart) {
  const auto judged = judged_dead_reckoning(recording(), {});
  EXPECT_EQ(judged.covariances[0], 1e-4 * Eigen::Matrix3d::Identity());
  EXPECT_GT(judged.covariances[1](0, 0), 1e-4);
}

}  // namespace
}  // namespace fathom
