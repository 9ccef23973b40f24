// The filters with absolute measurements and an uncertain start against naive dense ones, and all
// estimators where the world's coordinates are large.

#include <algorithm>

#include <gtest/gtest.h>

#include "src/harness/conformance/world_logs.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive_world_filters.hpp"

namespace fathom::test {
namespace {

std::vector<MeasurementLog> logs() {
  std::vector<MeasurementLog> all;
  for (const bool is_fixed : {true, false}) {
    WorldOptions options;
    options.start =
        is_fixed ? StartPose({1.0, 2.0, -3.0}) : uncertain_start({1.0, 2.0, -3.0}, 0.3, 0.1);
    all.push_back(circle_in_world(options));
    options.pose_every = 6;
    options.heading_every = 3;
    all.push_back(circle_in_world(options));
  }
  return all;
}

template <class Naive>
void expect_same(const Estimator& estimator, const Naive& naive, double tolerance) {
  EXPECT_LT(largest_distance(poses_of(estimator), naive.trajectory()), tolerance);
  EXPECT_LT(largest_turn(poses_of(estimator), naive.trajectory()), tolerance);
  for (std::size_t k = 0; k < estimator.size(); ++k) {
    const Eigen::Matrix3d expected = naive.covariance(k);
    EXPECT_LT((*estimator.covariance(k) - expected).norm(), 1e-6 * expected.norm() + 1e-15) << k;
  }
}

TEST(WorldFilters, EkfIsTheNaiveOne) {
  for (const MeasurementLog& log : logs()) {
    expect_same(*solved("ekf", log), run_naive_in_world(NaiveWorldEkf(log.start()), log), 1e-9);
  }
}

TEST(WorldFilters, TrajectoryIekfIsTheNaiveOne) {
  for (const int iterations : {1, 3}) {
    const EstimatorValues values_of{
        {"max_iterations", OptionValue::scalar(std::to_string(iterations))},
        {"tolerance", OptionValue::scalar("1e-300")}};
    for (const MeasurementLog& log : logs()) {
      const NaiveWorldTrajectoryIekf naive(log.start(), iterations);
      expect_same(*solved("trajectory_iekf", log, values_of), run_naive_in_world(naive, log), 1e-9);
    }
  }
}

// Its cost would be that of rounded coordinates, though the axes of keyframe 0 carry it.
TEST(FarWorld, LosesWhatItsCoordinatesDoNotResolve) {
  const MeasurementLog far = moved(with_precise_loop(7, 1e18), kFarWorld);
  for (const EstimatorEntry& entry : builtin_estimators().entries()) {
    SCOPED_TRACE(entry.name);
    std::vector<LoopDecision> decisions;
    const auto estimator = entry.create({far.start()}, {});
    EXPECT_EQ(feed(*estimator, far, &decisions), Outcome::numerical_failure);
    const auto is_lost = [](const LoopDecision& loop) { return loop.fate == LoopFate::lost; };
    EXPECT_EQ(std::ranges::count_if(decisions, is_lost), 1);
  }
  const std::vector<double> weights =
      solved("sparse_gauss_newton", far, values({{"loss", "huber"}}))->loop_weights();
  ASSERT_EQ(weights.size(), far.registration_count());
  EXPECT_EQ(std::ranges::count(weights, 0.0), 1);
}

}  // namespace
}  // namespace fathom::test
