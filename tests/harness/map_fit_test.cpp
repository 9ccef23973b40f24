#include "fathom/harness/map_fit.hpp"

#include <limits>

#include <Eigen/Cholesky>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
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
                                HasSubstr("either its covariance is too small"),
                                HasSubstr("or some loops are wrong and bend it"))));
  fit.steps_at_optimum = 100.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("loops are wrong")));
  fit.absolute_at_optimum = 600.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("absolute measurements")));
}

// Rounds of a square with loops of a tenth of the σ of steps, errors drawn from what is stated; but
// those of steps are `factor` times as large, and one loop may be 1 m off.
MapFit fit_of_rounds(double factor, bool with_false_loop, std::size_t rounds = 15) {
  const Eigen::Matrix3d covariance = test::square_covariance();
  const Eigen::Matrix3d root = covariance.llt().matrixL();
  RandomStream random(3);
  const auto drawn = [&](const Pose& motion, double times) {
    const Eigen::Vector3d unit{random.normal(), random.normal(), random.normal()};
    const Eigen::Vector3d e = times * root * unit;
    return compose(motion, {e.x(), e.y(), e.z()});
  };
  const Pose step{1.0, 0.0, M_PI / 2};
  MeasurementLog log(Pose{});
  for (std::size_t k = 1; k <= 4 * rounds; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, drawn(step, factor), covariance));
    if (k < 4) continue;
    Pose loop = drawn(Pose{}, 0.1);
    if (with_false_loop && k == 4) loop.x += 1.0;
    log.add_registration(RelativePose::from_covariance(k - 4, k, loop, 0.01 * covariance));
  }
  const auto optimum = batch_optimum(log, builtin_estimators());
  return map_fit(log, optimum.value().poses, *optimum).value();
}

TEST(MapFit, LoopsSayWhyDeadReckoningDoesNotFitThem) {
  EXPECT_FALSE(fit_of_rounds(1.0, false).measurements_disagree());
  const MapFit scaled = fit_of_rounds(10.0, false);
  EXPECT_TRUE(scaled.is_far_above_chance());
  EXPECT_EQ(scaled.step_blame(), StepBlame::covariance);
  const MapFit one_is_false = fit_of_rounds(1.0, true);
  EXPECT_TRUE(one_is_false.is_far_above_chance());
  EXPECT_EQ(one_is_false.step_blame(), StepBlame::loops);
  // A few loops alone miss alike whatever is wrong.
  const MapFit few = fit_of_rounds(1.0, true, 2);
  EXPECT_TRUE(few.is_far_above_chance());
  EXPECT_EQ(few.step_blame(), StepBlame::unclear);
}

TEST(MapFit, WhoIsToBlameIsSaid) {
  MapFit fit{.chi2 = 900.0, .chi2_optimum = 900.0, .degrees_of_freedom = 90.0, .unknowns = 90.0};
  fit.steps_at_optimum = 700.0;
  fit.steps = {60, 11.7, 8.0, 50.0};
  fit.registrations = {30, 6.7, 5.2, 20.0};
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"),
              ElementsAre(AllOf(HasSubstr("loops miss alike (NIS: median 5.2, mean 6.7), so its "
                                          "covariance is too small"),
                                HasSubstr("dataset.added_noise"))));
  fit.registrations.median = 0.2;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"),
              ElementsAre(AllOf(HasSubstr("these are wrong and bend it (a robust loss, a gate)"),
                                Not(HasSubstr("dataset.added_noise")))));
  fit.registrations = {30, 1.7, 1.2, 5.0};
  fit.steps.median = 0.3;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("it slips there")));
}

// By hand: the quantile of χ² with three degrees of freedom at 1 − 1e-8 is 40.13.
TEST(MapFit, OneFalseLoopAmongManyIsFoundByItsNis) {
  MapFit fit{.chi2 = 240.0, .chi2_optimum = 240.0, .degrees_of_freedom = 300.0, .unknowns = 90.0};
  fit.registrations = {100, 2.0, 1.0, 39.0};
  EXPECT_NEAR(fit.largest_nis_by_chance(), 40.13, 0.005);
  EXPECT_FALSE(fit.measurements_disagree());
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), IsEmpty());
  fit.registrations.largest = 41.0;
  EXPECT_TRUE(fit.measurements_disagree());
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"),
              ElementsAre(AllOf(HasSubstr("a loop contradicts the other measurements: it has NIS "
                                          "41, and chance leaves 40.1 at most"))));
  EXPECT_THAT(map_remarks(fit, "ekf", "solver", true), IsEmpty());
  // All covariances may be too small by two.
  fit.chi2 = fit.chi2_optimum = 600.0;
  EXPECT_FALSE(fit.measurements_disagree());
  // One that rejected it is not held against the optimum of all loops.
  fit = {.chi2 = 900.0,
         .chi2_used = 200.0,
         .chi2_optimum = 240.0,
         .degrees_of_freedom = 300.0,
         .unknowns = 90.0};
  fit.registrations = {100, 2.0, 1.0, 41.0};
  EXPECT_THAT(map_remarks(fit, "robust", "solver"),
              ElementsAre(AllOf(HasSubstr("robust rejected or weighed down"),
                                HasSubstr("a loop has NIS 41"), Not(HasSubstr("would do")))));
}

// What considers shared errors minimises no F.
TEST(MapFit, GainsThatConsiderSharedErrorsAreNoMisfit) {
  MapFit fit{
      .chi2 = 3239.7, .chi2_optimum = 2751.3, .degrees_of_freedom = 3828.0, .unknowns = 375.0};
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("solver would do")));
  fit.considers_shared_errors = true;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), IsEmpty());
  // Beyond three per degree of freedom it has diverged.
  fit.chi2 = 2751.3 + 3.1 * 3828.0;
  EXPECT_THAT(map_remarks(fit, "ekf", "solver"), ElementsAre(HasSubstr("solver would do")));
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
