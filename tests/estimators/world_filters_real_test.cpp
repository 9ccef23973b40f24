// The filters on real graphs with absolute measurements, against naive dense ones.

#include <gtest/gtest.h>

#include "fathom/measurements/g2o.hpp"
#include "src/harness/conformance/world_logs.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive_world_filters.hpp"
#include "tests/support/data.hpp"

namespace fathom::test {
namespace {

// With what a compass and a positioning system would say if a batch solution were the truth.
MeasurementLog measured_in_world(const std::string& file) {
  const MeasurementLog log = read_g2o(data_path(file));
  const auto batch =
      builtin_estimators().find("sparse_gauss_newton").create({log.start(), SolveMode::batch}, {});
  feed(*batch, log);
  WorldOptions options;
  options.heading_every = 20;
  options.position_every = 50;
  options.pose_every = 130;
  options.start = uncertain_start(log.origin(), 0.1, 0.02);
  return in_world(log, poses_of(*batch), options);
}

class WorldFiltersReal : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Shared, WorldFiltersReal, testing::Values("ring", "CSAIL"),
                         [](const auto& name) { return name.param; });

TEST_P(WorldFiltersReal, AreTheNaiveOnes) {
  const std::string file = "pose_graphs/" + GetParam() + ".g2o";
  FATHOM_REQUIRE_DATA(file);
  const MeasurementLog log = measured_in_world(file);
  ASSERT_GT(log.absolute_count(), 25U);
  // The naive ones take every update, however bad it makes the fit.
  const EstimatorValues any = values({{"divergence_factor", "1e30"}});
  const auto ekf = run_naive_in_world(NaiveWorldEkf(log.start()), log);
  EXPECT_LT(largest_distance(poses_of(*solved("ekf", log, any)), ekf.trajectory()), 1e-6);
  const EstimatorValues three =
      values({{"max_iterations", "3"}, {"tolerance", "1e-300"}, {"divergence_factor", "1e30"}});
  const auto iekf = run_naive_in_world(NaiveWorldTrajectoryIekf(log.start(), 3), log);
  EXPECT_LT(largest_distance(poses_of(*solved("trajectory_iekf", log, three)), iekf.trajectory()),
            1e-6);
}

}  // namespace
}  // namespace fathom::test
