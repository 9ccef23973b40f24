#include "fathom/harness/map_fit.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/estimators/builtin.hpp"
#include "harness/square_log.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

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
              ElementsAre(AllOf(HasSubstr("no map of ekf"), HasSubstr("solver, which"),
                                Not(HasSubstr("nan")))));
}

TEST(MapFit, MeasurementsThatDoNotFitEachOtherAreBlamedByTheirShare) {
  MapFit fit{.chi2 = 900.0, .chi2_optimum = 900.0, .degrees_of_freedom = 90.0, .unknowns = 90.0};
  fit.steps_at_optimum = 700.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"),
              ElementsAre(AllOf(HasSubstr("is 10 at its best"), HasSubstr("78 %"),
                                HasSubstr("too small for what loops say"))));
  fit.steps_at_optimum = 100.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("loops are wrong")));
  fit.absolute_at_optimum = 600.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("absolute measurements")));
}

// False loops, rejected: the batch optimum takes them, and folds its map for them.
TEST(MapFit, WhatLeavesLoopsOutIsNotHeldAgainstAnOptimumOfAllLoops) {
  MapFit fit{.chi2 = 1e7, .chi2_optimum = 4e4, .degrees_of_freedom = 3e3, .unknowns = 3e3};
  fit.chi2_used = 2.9e3;
  EXPECT_TRUE(fit.leaves_out_most());
  EXPECT_THAT(map_remarks(fit, "robust", "solver"),
              ElementsAre(AllOf(HasSubstr("robust rejected or weighed down"), HasSubstr("2900"),
                                Not(HasSubstr("would do")))));
  // All loops fit one map, so that they are right, and the filter lost them.
  fit.chi2_optimum = 3e3;
  EXPECT_FALSE(fit.leaves_out_most());
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("solver would do")));
  fit.chi2_optimum = 4e4;
  fit.chi2_used = 9e6;
  EXPECT_FALSE(fit.leaves_out_most());
  EXPECT_THAT(map_remarks(fit, "gated", "solver"), Contains(HasSubstr("solver would do")));
}

TEST(MapFit, RegistrationsThatAgreeTooWellShareErrors) {
  MapFit fit{.chi2_optimum = 61.0, .degrees_of_freedom = 100.0};
  EXPECT_FALSE(sharing_remark(fit, "ekf"));
  fit.chi2_optimum = 43.0;
  EXPECT_THAT(sharing_remark(fit, "ekf").value(),
              AllOf(HasSubstr("is 0.43 at its best"), HasSubstr("which ekf takes as independent")));
}

// By hand: a row of a heading, two of a fix, three less of the hole; of keyframe 0 only if it is
// not held.
TEST(MapFit, HeadingsFixesAndHolesHaveTheirDegreesOfFreedom) {
  const MeasurementLog square = test::square_log();
  const auto dof_of = [&](const StartPose& start, bool with_hole) {
    MeasurementLog log(start);
    log.add_absolute(AbsolutePose::heading(0, 0.0, 0.1));
    for (std::size_t k = 1; k < square.size(); ++k) {
      RelativePose step = square.arrival(k).step;
      step.is_hole = with_hole && k == 2;
      log.add_keyframe(step);
      for (const RelativePose& z : square.arrival(k).registrations) log.add_registration(z);
    }
    const std::size_t last = log.size() - 1;
    log.add_absolute(AbsolutePose::heading(last, 0.0, 0.1));
    log.add_absolute(AbsolutePose::position(last, {0.0, 0.0}, Eigen::Matrix2d::Identity()));
    return map_fit(log, log.odometry(), {log.odometry(), 1.0, ""}).value();
  };
  EXPECT_EQ(dof_of(Pose{}, false).degrees_of_freedom, 16.0);
  EXPECT_EQ(dof_of(Pose{}, true).degrees_of_freedom, 13.0);
  StartPose uncertain;
  uncertain.covariance = Eigen::Matrix3d::Identity();
  EXPECT_EQ(dof_of(uncertain, false).degrees_of_freedom, 16.0);
  EXPECT_EQ(dof_of(uncertain, false).unknowns, 24.0);
}

}  // namespace
}  // namespace fathom
