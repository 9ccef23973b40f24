// incremental_smoother with the errors that pictures share among its unknowns, against dense least
// squares and against the whole graph.

#include <gtest/gtest.h>

#include "estimators/incremental_smoother/incremental_smoother.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/measurements/g2o.hpp"
#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/measurements/shared_log.hpp"

namespace fathom {
namespace {

using conformance::NaiveLeastSquares;
using test::arrive;
using test::SharedWalk;

// A gate that lets all pass leaves no registration to its picture alone.
EstimatorValues exactly(bool is_gated) {
  EstimatorValues values = test::exactly();
  if (is_gated) values["gate_probability"] = OptionValue::scalar("0.999999999");
  return values;
}

void add_arrival(MeasurementLog& log, const KeyframeMeasurements& arrival) {
  log.add_keyframe(arrival.step);
  for (const RelativePose& z : arrival.registrations) log.add_registration(z);
}

NaiveLeastSquares optimum_of(const MeasurementLog& log) {
  return conformance::least_squares(log, 30, {}, RegistrationErrors::shared);
}

void expect_poses(const Estimator& estimator, const std::vector<Pose>& expected, double limit) {
  for (std::size_t k = 0; k < expected.size(); ++k) {
    ASSERT_LT(between(expected[k], estimator.pose(k)).vector().norm(), limit) << k;
  }
}

void expect_covariances(const Estimator& estimator, const NaiveLeastSquares& expected) {
  const std::size_t newest = expected.poses.size() - 1;
  for (std::size_t k = 0; k <= newest; ++k) {
    const Eigen::Matrix3d marginal = expected.marginal(k);
    ASSERT_LT((*estimator.covariance(k) - marginal).norm(), 1e-6 * marginal.norm() + 1e-15) << k;
  }
  const std::vector<std::size_t> some{newest, newest / 7, 0, newest / 2, newest / 7};
  EXPECT_LT(conformance::largest_block_difference(*estimator.joint_covariance(some),
                                                  expected.joint(some)),
            1e-6);
  const auto motions = estimator.motions_to_newest();
  ASSERT_TRUE(motions);
  for (std::size_t k = 0; k < motions->size(); ++k) {
    const Eigen::Matrix3d motion = expected.motion_to_newest(k).covariance;
    EXPECT_LT(((*motions)[k].covariance - motion).norm(), 1e-6 * motion.norm()) << k;
  }
}

TEST(SharedSmoother, EqualsLeastSquaresAfterEveryKeyframe) {
  for (const int per_keyframe : {1, 2, 5}) {
    for (const bool is_gated : {false, true}) {
      SCOPED_TRACE(std::to_string(per_keyframe) + (is_gated ? " gated" : ""));
      const MeasurementLog log = SharedWalk(30, per_keyframe, 11).log;
      const auto estimator = test::make("incremental_smoother", log.start(), exactly(is_gated));
      EXPECT_TRUE(estimator->estimates_shared_errors());
      MeasurementLog so_far(log.start());
      for (std::size_t k = 1; k < log.size(); ++k) {
        ASSERT_EQ(arrive(*estimator, log, k).outcome, Outcome::converged);
        add_arrival(so_far, log.arrival(k));
        const NaiveLeastSquares expected = optimum_of(so_far);
        expect_poses(*estimator, expected.poses, 1e-6);
        // The factor that is kept is linearised near the estimate.
        const Eigen::Matrix3d newest = expected.marginal(k);
        EXPECT_LT((*estimator->newest_covariance() - newest).norm(), 0.02 * newest.norm()) << k;
        if (k % 7 == 0 || k + 1 == log.size()) expect_covariances(*estimator, expected);
      }
    }
  }
}

TEST(SharedSmoother, IsAtTheOptimumOfTheWholeGraph) {
  const EstimatorValues exactly = test::values({{"tolerance", "1e-15"}});
  for (const int per_keyframe : {1, 3}) {
    const MeasurementLog log = SharedWalk(300, per_keyframe, 4).log;
    const auto ours = test::make("incremental_smoother", log.start(), exactly);
    const auto whole = test::make("sparse_gauss_newton", log.start(), exactly);
    for (std::size_t k = 1; k < log.size(); ++k) {
      ASSERT_EQ(arrive(*ours, log, k).outcome, Outcome::converged) << k;
      arrive(*whole, log, k);
      if (k % 10 == 0 || k + 1 == log.size()) expect_poses(*ours, poses_of(*whole), 1e-6);
    }
  }
}

TEST(SharedSmoother, StaysWithinAFewThousandthsOfTheOptimumByDefault) {
  for (const int per_keyframe : {1, 2, 4}) {
    const MeasurementLog log = SharedWalk(150, per_keyframe, 8).log;
    const auto ours = test::make("incremental_smoother", log.start());
    const auto whole = test::make("sparse_gauss_newton", log.start(), test::exactly());
    MeasurementLog so_far(log.start());
    for (std::size_t k = 1; k < log.size(); ++k) {
      arrive(*ours, log, k);
      arrive(*whole, log, k);
      add_arrival(so_far, log.arrival(k));
      if (k % 10 != 0) continue;
      EXPECT_LT(shared_chi2(so_far, poses_of(*ours)),
                1.003 * shared_chi2(so_far, poses_of(*whole)) + 1e-6)
          << k;
    }
  }
}

TEST(SharedSmoother, IsTheSameTwice) {
  const MeasurementLog log = SharedWalk(120, 3, 2).log;
  const auto first = test::solved("incremental_smoother", log);
  const auto second = test::solved("incremental_smoother", log);
  EXPECT_EQ(poses_of(*first), poses_of(*second));
}

TEST(SharedSmoother, IndependentIsWhatAGraphIsThatIsToldNothing) {
  const MeasurementLog log = SharedWalk(60, 4, 11).log;
  const MeasurementLog untold = parse_g2o(to_g2o(log), "graph.g2o");
  const auto estimator =
      test::solved("incremental_smoother", log, test::values({{"shared_errors", "independent"}}));
  EXPECT_FALSE(estimator->estimates_shared_errors());
  const auto expected = test::solved("incremental_smoother", untold);
  for (std::size_t k = 0; k < log.size(); ++k) {
    EXPECT_EQ(estimator->pose(k), expected->pose(k));
    EXPECT_EQ(*estimator->covariance(k), *expected->covariance(k));
  }
}

TEST(SharedGraph, RefusesToConsider) {
  for (const char* graph : {"incremental_smoother", "sparse_gauss_newton", "ceres_pose_graph"}) {
    EXPECT_THROW(test::make(graph, {}, test::values({{"shared_errors", "consider"}})), InputError);
  }
}

}  // namespace
}  // namespace fathom
