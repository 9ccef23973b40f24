// sparse_gauss_newton with loops that all stand in one group: only dead reckoning can judge it.

#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "tests/estimators/graph_parts.hpp"

namespace fathom {
namespace {

std::vector<double> truncated_weights(const MeasurementLog& log, SolveMode mode) {
  const auto estimator = builtin_estimators()
                             .find("sparse_gauss_newton")
                             .create({log.origin(), mode}, test::values({{"loss", "truncated"}}));
  test::feed(*estimator, log);
  return estimator->loop_weights();
}

// Out along a line and back: loops across, all of them one group, `shift_m` off along the line.
MeasurementLog there_and_back(std::size_t keyframes, std::size_t loops, double shift_m) {
  std::vector<Pose> truth;
  for (std::size_t k = 0; k < keyframes; ++k) {
    const bool is_back = 2 * k >= keyframes;
    truth.push_back({static_cast<double>(is_back ? keyframes - 1 - k : k), is_back ? 0.5 : 0.0,
                     is_back ? std::numbers::pi : 0.0});
  }
  RandomStream random(4, "loops");
  MeasurementLog log;
  for (std::size_t k = 1; k < keyframes; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, between(truth[k - 1], truth[k]),
                                                   1e-4 * Eigen::Matrix3d::Identity()));
    for (std::size_t back = 1; back <= 4; ++back) {
      const std::size_t from = keyframes - k + back;
      if (2 * k < keyframes || from >= keyframes / 2 || log.registration_count() == loops) continue;
      Pose shifted = truth[k];
      shifted.x += shift_m;
      log.add_registration(RelativePose::from_covariance(
          from, k, test::perturbed(between(truth[from], shifted), 0.05, 0.05, random),
          0.0025 * Eigen::Matrix3d::Identity()));
    }
  }
  return log;
}

// Their common error is small beside what each of them may have, not beside that of the steps.
TEST(RobustGroups, KeepsAGroupOfAllLoopsWhoseCommonErrorTheStepsContradict) {
  const MeasurementLog log = there_and_back(60, 1000, 0.05);
  ASSERT_GT(log.registration_count(), 80u);
  for (const SolveMode mode : {SolveMode::batch, SolveMode::incremental}) {
    const std::vector<double> weights = truncated_weights(log, mode);
    // Near the turn the steps contradict single loops, too.
    EXPECT_GE(std::ranges::count_if(weights, [](double weight) { return weight > 0.5; }),
              0.95 * static_cast<double>(weights.size()));
  }
}

TEST(RobustGroups, RejectsAGroupOfAllLoopsThatIsFarOff) {
  const MeasurementLog log = there_and_back(60, 5, 10.0);
  ASSERT_EQ(log.registration_count(), 5u);
  for (const SolveMode mode : {SolveMode::batch, SolveMode::incremental}) {
    for (const double weight : truncated_weights(log, mode)) EXPECT_LE(weight, 0.5);
  }
}

}  // namespace
}  // namespace fathom
