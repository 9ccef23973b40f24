// sparse_gauss_newton with loss truncated: how well registrations agree is no word on fixes.

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/estimators/graph_parts.hpp"

namespace fathom {
namespace {

constexpr double kFixSigmaM = 0.3;

// Loops whose σ are √1000 times what their errors are, so that the scale of registrations falls,
// and fixes with errors as they say, the one of keyframe `wrong` off by 20 σ beside.
MeasurementLog modest_loops_and_fixes(std::size_t wrong) {
  const std::vector<Pose> truth = test::circle(120);
  RandomStream random(6, "modest");
  MeasurementLog log;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    log.add_keyframe(RelativePose::from_covariance(
        k - 1, k, test::perturbed(between(truth[k - 1], truth[k]), 0.01, 0.002, random),
        Eigen::Vector3d(1e-4, 1e-4, 4e-6).asDiagonal()));
    if (k >= 60 && k % 2 == 0) {
      log.add_registration(RelativePose::from_covariance(
          k - 60, k, test::perturbed(between(truth[k - 60], truth[k]), 0.01, 0.005, random),
          Eigen::Vector3d(0.1, 0.1, 0.025).asDiagonal()));
    }
    if (k % 4 != 0) continue;
    const Eigen::Vector2d error(random.normal(), random.normal() + (k == wrong ? 20.0 : 0.0));
    log.add_absolute(AbsolutePose::position(k, truth[k].position() + kFixSigmaM * error,
                                            kFixSigmaM * kFixSigmaM * Eigen::Matrix2d::Identity()));
  }
  return log;
}

std::unique_ptr<Estimator> solved(const MeasurementLog& log, SolveMode mode,
                                  const EstimatorValues& more = {}) {
  EstimatorValues values = test::values({{"loss", "truncated"}});
  values.insert(more.begin(), more.end());
  auto estimator =
      builtin_estimators().find("sparse_gauss_newton").create({log.origin(), mode}, values);
  test::feed(*estimator, log);
  return estimator;
}

TEST(RobustAbsolute, KeepsRightFixesWhereRegistrationsAgreeBetterThanTheySay) {
  const MeasurementLog log = modest_loops_and_fixes(0);
  for (const SolveMode mode : {SolveMode::batch, SolveMode::incremental}) {
    const std::vector<double> weights = solved(log, mode)->absolute_weights();
    ASSERT_EQ(weights.size(), 29U);
    for (const double weight : weights) EXPECT_EQ(weight, 1.0);
  }
}

TEST(RobustAbsolute, RejectsAWrongFixThere) {
  const MeasurementLog log = modest_loops_and_fixes(60);
  for (const SolveMode mode : {SolveMode::batch, SolveMode::incremental}) {
    const std::vector<double> weights = solved(log, mode)->absolute_weights();
    ASSERT_EQ(weights.size(), 29U);
    for (std::size_t j = 0; j < weights.size(); ++j) EXPECT_EQ(weights[j], j == 14 ? 0.0 : 1.0);
  }
}

// The premise: a registration that is off by what the default scale would take is rejected.
TEST(RobustAbsolute, StillLowersTheScaleOfRegistrations) {
  MeasurementLog log = modest_loops_and_fixes(0);
  log.add_registration(RelativePose::from_covariance(
      61, 119, compose(between(test::circle(120)[61], test::circle(120)[119]), {0.6, 0.0, 0.0}),
      Eigen::Vector3d(0.1, 0.1, 0.025).asDiagonal()));
  for (const SolveMode mode : {SolveMode::batch, SolveMode::incremental}) {
    EXPECT_EQ(solved(log, mode)->loop_weights().back(), 0.0);
    EXPECT_EQ(solved(log, mode, test::values({{"loss_scale", "4.44"}}))->loop_weights().back(),
              1.0);
  }
}

}  // namespace
}  // namespace fathom
