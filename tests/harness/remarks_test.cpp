#include "fathom/harness/remarks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"
#include "harness/square_log.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Sees 2.56 m abeam and 1.92 m ahead.
constexpr double kAltitudeM = 2.0;

/// A survey at these true poses: exact steps, and registrations of what the test says.
Recording survey(const std::vector<Pose>& poses) {
  Recording recording;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    recording.log.add_keyframe(RelativePose::from_covariance(
        k - 1, k, between(poses[k - 1], poses[k]), 1e-4 * Eigen::Matrix3d::Identity()));
  }
  recording.camera = Camera();
  recording.keyframe_altitudes_m.assign(poses.size(), kAltitudeM);
  recording.in_metres.emplace();
  recording.in_metres->reach_m = {2.3, 2.3, 2.3};
  return recording;
}

/// The same with a registration of each keyframe with the one before, its length wrong by `scale`.
Recording chained(const std::vector<Pose>& poses, double scale) {
  Recording recording = survey(poses);
  MeasurementLog log;
  for (std::size_t k = 1; k < poses.size(); ++k) {
    const RelativePose& step = recording.log.arrival(k).step;
    log.add_keyframe(step);
    const Pose motion{scale * step.motion.x, scale * step.motion.y, step.motion.theta};
    log.add_registration(RelativePose::from_covariance(k - 1, k, motion, step.covariance()));
    ++recording.registrations_tried;
  }
  recording.log = log;
  return recording;
}

std::vector<Pose> ahead(std::size_t count, double step_m) {
  std::vector<Pose> poses;
  for (std::size_t k = 0; k < count; ++k) poses.push_back({step_m * static_cast<double>(k), 0, 0});
  return poses;
}

std::vector<std::string> remarks_on(const Recording& recording) {
  return loop_remarks(recording, {}, recording.log.odometry());
}

TEST(LoopRemarks, WithoutCandidatesNameTheReachAndTheNearestPass) {
  EXPECT_THAT(remarks_on(survey(ahead(20, 3.0))),
              ElementsAre(AllOf(HasSubstr("no loop candidates among 20 keyframes"),
                                HasSubstr("2.3 m"), HasSubstr("never returns"))));
  std::vector<Pose> out_and_back = ahead(10, 3.0);
  for (int k = 9; k >= 0; --k) out_and_back.push_back({3.0 * k, 7.0, M_PI});
  EXPECT_THAT(remarks_on(survey(out_and_back)),
              ElementsAre(AllOf(HasSubstr("nearest pass"), HasSubstr("is 7 m away"),
                                HasSubstr("max_distance_m"))));
}

TEST(LoopRemarks, WithoutARegistrationNameTheBestRefused) {
  Recording recording = survey(ahead(5, 0.5));
  recording.registrations_tried = 10;
  recording.most_refused_inliers = 9;
  EXPECT_THAT(remarks_on(recording),
              ElementsAre(AllOf(HasSubstr("0 of 10 candidate pairs"), HasSubstr("9 matches agree"),
                                HasSubstr("at least 12"))));
}

TEST(LoopRemarks, WhatIsRightHasNone) {
  EXPECT_THAT(remarks_on(chained(ahead(12, 1.0), 1.0)), IsEmpty());
  EXPECT_THAT(remarks_on(chained(ahead(12, 1.0), 1.1)), IsEmpty());
}

TEST(LoopRemarks, AnAltitudeInFeetIsAFactor) {
  EXPECT_THAT(remarks_on(chained(ahead(12, 1.0), 3.28)),
              ElementsAre(AllOf(HasSubstr("3.28 times as long"), HasSubstr("too large"))));
  EXPECT_THAT(remarks_on(chained(ahead(12, 1.0), 0.5)),
              ElementsAre(AllOf(HasSubstr("0.5 times as long"), HasSubstr("too small"))));
  // Visual odometry is made of the same registrations: it cannot tell.
  Recording visual = chained(ahead(12, 1.0), 3.28);
  visual.visual_odometry = true;
  EXPECT_THAT(remarks_on(visual), IsEmpty());
}

// 0.4 m apart each keyframe shares 30 % or more with the next three: 1.2 of 1.92 m.
TEST(LoopRemarks, FewerRegistrationsThanTheOverlapPromisesAreCounted) {
  const Recording recording = chained(ahead(12, 0.4), 1.0);
  EXPECT_THAT(remarks_on(recording),
              ElementsAre(AllOf(HasSubstr("11 registrations"), HasSubstr("30 pairs"))));
}

TEST(MapFit, AddsUpAndIsJudgedByThePosterior) {
  const MeasurementLog log = test::square_log();
  const auto optimum = batch_optimum(log, builtin_estimators());
  ASSERT_TRUE(optimum);
  const auto fit = map_fit(log, optimum->poses, *optimum);
  ASSERT_TRUE(fit);
  double steps = 0.0;
  for (const RelativePose& z : log.edges()) {
    if (z.to != z.from + 1) continue;
    const Eigen::Vector3d e = residual(z.motion, optimum->poses[z.from], optimum->poses[z.to]);
    steps += e.dot(z.information * e);
  }
  EXPECT_EQ(fit->chi2, fit->chi2_optimum);
  EXPECT_NEAR(fit->steps_at_optimum, steps, 1e-12 * steps);
  EXPECT_NEAR(fit->registration_sigma_m, std::sqrt(0.1 * 6e-4), 1e-12);
  EXPECT_NEAR(fit->registration_sigma_rad, std::sqrt(0.1 * 1e-4), 1e-12);
  EXPECT_GT(fit->registration_rms_m, 0.0);
  EXPECT_EQ(fit->degrees_of_freedom, 12.0);
  EXPECT_EQ(fit->unknowns, 21.0);
  EXPECT_TRUE(fit->estimate_fits());
  EXPECT_FALSE(map_fit(MeasurementLog(), {}, *optimum));
}

// χ² with three degrees of freedom is below 11.345 in 99 of 100 draws.
TEST(MapFit, AnEstimateFitsIfThePosteriorWouldDrawIt) {
  MapFit fit{.chi2_optimum = 100.0, .degrees_of_freedom = 100.0, .unknowns = 3.0};
  fit.chi2 = 111.34;
  EXPECT_TRUE(fit.estimate_fits());
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), IsEmpty());
  fit.chi2 = 111.36;
  EXPECT_FALSE(fit.estimate_fits());
  // With covariances that are too small by four, F counts a quarter.
  fit.degrees_of_freedom = 25.0;
  EXPECT_TRUE(fit.estimate_fits());
  fit.chi2 = 145.40;
  EXPECT_FALSE(fit.estimate_fits());
  fit.degrees_of_freedom = 100.0;
  fit.chi2 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(fit.estimate_fits());
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"),
              ElementsAre(AllOf(HasSubstr("the map of ekf"), HasSubstr("solver would do"))));
}

TEST(MapFit, MeasurementsThatDoNotFitEachOtherAreBlamedByTheirShare) {
  MapFit fit{.chi2 = 900.0, .chi2_optimum = 900.0, .degrees_of_freedom = 90.0, .unknowns = 90.0};
  fit.steps_at_optimum = 700.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"),
              ElementsAre(AllOf(HasSubstr("is 10 at its best"), HasSubstr("78 %"),
                                HasSubstr("too small for what loops say"))));
  fit.steps_at_optimum = 100.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("loops are wrong")));
}

}  // namespace
}  // namespace fathom
