// Loops that an estimate was made without, against that estimate.

#include "fathom/evaluation/held_out.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "evaluation/example_run.hpp"
#include "fathom/core/input_error.hpp"
#include "support/numbers.hpp"

namespace fathom {
namespace {

Eigen::Matrix3d full_covariance(double scale) {
  Eigen::Matrix3d C;
  C << 4.0, 1.0, -0.5,  //
      1.0, 2.0, 0.3,    //
      -0.5, 0.3, 1.0;
  return scale * C;
}

// Headings on both sides of ±π; one of the loops is written from its later end.
HeldOutLoops two_loops() {
  HeldOutLoops held_out;
  held_out.estimate = {{0.0, 0.0, 0.5}, {2.0, 1.0, 3.1}, {1.0, 3.0, -3.0}};
  const auto off = [&](std::size_t from, std::size_t to, const Pose& error) {
    const Pose h = between(held_out.estimate[from], held_out.estimate[to]);
    const Pose z{h.x + error.x, h.y + error.y, wrap_angle(h.theta + error.theta)};
    held_out.loops.push_back(RelativePose::from_covariance(from, to, z, full_covariance(0.01)));
  };
  off(0, 1, {0.3, 0.4, 0.6});
  off(2, 1, {0.0, -0.1, -0.2});
  held_out.tested = {0, 1};
  held_out.covariances = {full_covariance(0.03), 0.02 * Eigen::Matrix3d::Identity()};
  return held_out;
}

TEST(HeldOut, ErrorsAreMediansAndRootMeanSquares) {
  const auto errors = held_out_errors(two_loops());
  ASSERT_TRUE(errors);
  EXPECT_NEAR(errors->position_median_m, 0.3, 1e-12);
  EXPECT_NEAR(errors->position_rmse_m, std::sqrt((0.25 + 0.01) / 2.0), 1e-12);
  EXPECT_NEAR(errors->heading_median_rad, 0.4, 1e-12);
  EXPECT_NEAR(errors->heading_rmse_rad, std::sqrt((0.36 + 0.04) / 2.0), 1e-12);
}

// In the axes of the residual of F, where Ω is what the log has.
TEST(HeldOut, NisIsThatOfTheResidual) {
  const HeldOutLoops held_out = two_loops();
  double expected = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const RelativePose& z = held_out.loops[i];
    const Eigen::Vector3d e =
        residual(z.motion, held_out.estimate[z.from], held_out.estimate[z.to]);
    Eigen::Matrix3d D = Eigen::Matrix3d::Identity();
    D.topLeftCorner<2, 2>() << std::cos(z.motion.theta), -std::sin(z.motion.theta),
        std::sin(z.motion.theta), std::cos(z.motion.theta);
    const Eigen::Matrix3d S = D.transpose() * held_out.covariances[i] * D + z.information.inverse();
    expected += 0.5 * e.dot(S.inverse() * e);
  }
  EXPECT_NEAR(held_out_errors(held_out)->mean_nis.value(), expected, 1e-10 * expected);
}

TEST(HeldOut, OfSomeLoopsAloneTheNisIsTested) {
  HeldOutLoops held_out = two_loops();
  held_out.tested = {1};
  held_out.covariances.erase(held_out.covariances.begin());
  const Eigen::Vector3d off(0.0, -0.1, -0.2);
  const Eigen::Matrix3d S = 0.02 * Eigen::Matrix3d::Identity() + full_covariance(0.01);
  EXPECT_NEAR(held_out_errors(held_out)->mean_nis.value(), off.dot(S.inverse() * off), 1e-10);
  held_out.covariances.clear();
  EXPECT_FALSE(held_out_errors(held_out)->mean_nis);
  EXPECT_NEAR(held_out_errors(held_out)->position_median_m, 0.3, 1e-12);
}

TEST(HeldOut, WhatIsNotKnownIsAbsent) {
  EXPECT_FALSE(held_out_errors({}));
  HeldOutLoops held_out = two_loops();
  held_out.covariances[0](0, 0) = test::kNaN;
  EXPECT_FALSE(held_out_errors(held_out)->mean_nis);
  held_out = two_loops();
  held_out.covariances[0] = -full_covariance(0.03);
  EXPECT_FALSE(held_out_errors(held_out)->mean_nis);
  held_out.covariances.pop_back();
  EXPECT_THROW(held_out_errors(held_out), InputError);
  held_out = two_loops();
  held_out.estimate[0].y = test::kNaN;
  EXPECT_FALSE(held_out_errors(held_out));
}

TEST(HeldOut, AreMetrics) {
  const test::ExampleRun example;
  RunFacts facts = example.facts();
  EXPECT_FALSE(test::values_of(facts).contains("held_out_loops"));
  HeldOutLoops held_out;
  facts.held_out = &held_out;
  EXPECT_EQ(test::values_of(facts).at("held_out_loops"), 0.0);
  EXPECT_FALSE(test::values_of(facts).contains("held_out_nis"));
  held_out = two_loops();
  const auto values = test::values_of(facts);
  const auto errors = held_out_errors(held_out);
  EXPECT_EQ(values.at("held_out_loops"), 2.0);
  EXPECT_EQ(values.at("held_out_position_error_m"), errors->position_median_m);
  EXPECT_EQ(values.at("held_out_position_rmse_m"), errors->position_rmse_m);
  EXPECT_EQ(values.at("held_out_heading_error_rad"), errors->heading_median_rad);
  EXPECT_EQ(values.at("held_out_heading_rmse_rad"), errors->heading_rmse_rad);
  EXPECT_EQ(values.at("held_out_nis"), errors->mean_nis);
}

}  // namespace
}  // namespace fathom
