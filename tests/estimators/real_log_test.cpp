// Real pose graphs: recorded optima, recorded figures of an independent dense implementation, and
// the textbook filters of these tests.

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "estimators/ekf/ekf.hpp"
#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "fathom/measurements/g2o.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive_filters.hpp"
#include "tests/support/data.hpp"

namespace fathom {
namespace {

using test::largest_distance;
using test::solved;

std::string graph(const std::string& name) {
  return "pose_graphs/" + name + ".g2o";
}

MeasurementLog read(const std::string& name) {
  return read_g2o(test::data_path(graph(name)));
}

struct Optimum {
  std::string name;
  double chi2;
};

class BatchOptimum : public testing::TestWithParam<Optimum> {};

// Optima found by independent solvers (g2o, GTSAM, Ceres), as recorded with the data.
INSTANTIATE_TEST_SUITE_P(PoseGraphs, BatchOptimum,
                         testing::Values(Optimum{"intel", 45.0047}, Optimum{"CSAIL", 40.5551},
                                         Optimum{"manhattan", 3549.0368}, Optimum{"M3500", 137.913},
                                         Optimum{"ring", 11.1631}),
                         [](const auto& optimum) { return optimum.param.name; });

TEST_P(BatchOptimum, IsReachedFromOdometry) {
  FATHOM_REQUIRE_DATA(graph(GetParam().name));
  const MeasurementLog log = read(GetParam().name);
  const auto solver =
      builtin_estimators().find("ceres_pose_graph").create({log.origin(), SolveMode::batch}, {});
  EXPECT_EQ(test::feed(*solver, log), Outcome::converged);
  EXPECT_NEAR(chi2(log, poses_of(*solver)), GetParam().chi2, 1e-4 * GetParam().chi2);
}

struct FilterCase {
  std::string graph;
  std::string filter;
  int iterations;
  double chi2;  ///< of an independent dense implementation
};

class FilterOnRealLog : public testing::TestWithParam<FilterCase> {};

INSTANTIATE_TEST_SUITE_P(PoseGraphs, FilterOnRealLog,
                         testing::Values(FilterCase{"CSAIL", "trajectory_iekf", 3, 40.575},
                                         FilterCase{"CSAIL", "trajectory_iekf", 1, 40.706},
                                         FilterCase{"CSAIL", "ekf", 1, 41.38},
                                         FilterCase{"ring", "trajectory_iekf", 3, 186.34},
                                         FilterCase{"ring", "trajectory_iekf", 1, 141.63},
                                         FilterCase{"ring", "ekf", 1, 22.725}),
                         [](const auto& name) {
                           return name.param.graph + "_" + name.param.filter + "_" +
                                  std::to_string(name.param.iterations);
                         });

TEST_P(FilterOnRealLog, EqualsTheTextbookFilterAndTheRecordedCost) {
  const FilterCase& test = GetParam();
  FATHOM_REQUIRE_DATA(graph(test.graph));
  const MeasurementLog log = read(test.graph);
  const auto filter =
      builtin_estimators()
          .find(test.filter)
          .create({log.origin()},
                  test::values({{"max_iterations", std::to_string(test.iterations)}}));
  EXPECT_TRUE(is_done(test::feed(*filter, log)));
  EXPECT_NEAR(chi2(log, poses_of(*filter)), test.chi2, 2e-4 * test.chi2);
  const std::vector<Pose> reference =
      test.filter == "ekf" ? test::run_naive(test::NaiveEkf(log), log)
                           : test::run_naive(test::NaiveTrajectoryIekf(log, test.iterations), log);
  EXPECT_LT(largest_distance(poses_of(*filter), reference), 1e-3);
}

template <class Covariance>
bool is_positive_definite(const Covariance& P) {
  return P.full().llt().info() == Eigen::Success;
}

// All of intel: 785 loops. An update through a general solve loses definiteness after about 130,
// and it does not come back.
TEST(FiltersOnIntel, StayPositiveDefiniteAndEndNearTheOptimum) {
  FATHOM_REQUIRE_DATA(graph("intel"));
  const MeasurementLog log = read("intel");
  const auto run = [&log](auto& filter) {
    std::size_t updates = 0;
    for (std::size_t k = 1; k < log.size(); ++k) {
      filter.add_keyframe(log.arrival(k).step);
      if (log.arrival(k).registrations.empty()) continue;
      EXPECT_TRUE(is_done(filter.close_loops(log.arrival(k).registrations).outcome));
      if (++updates == 200) {
        EXPECT_TRUE(is_positive_definite(filter.state_covariance()));
      }
    }
    EXPECT_EQ(updates, 785U);
    EXPECT_TRUE(is_positive_definite(filter.state_covariance()));
    for (std::size_t k = 1; k < log.size(); k += 7) {
      EXPECT_TRUE(fathom::is_positive_definite(*filter.covariance(k)));
    }
  };
  Ekf ekf({log.origin()}, {});
  run(ekf);
  EXPECT_NEAR(chi2(log, poses_of(ekf)), 45.0047, 0.5);
  TrajectoryIekfOptions options;
  options.max_iterations = 3;
  TrajectoryIekf iekf({log.origin()}, options);
  run(iekf);
  EXPECT_NEAR(chi2(log, poses_of(iekf)), 45.0047, 2.0);
}

MeasurementLog first_of(const MeasurementLog& log, std::size_t keyframes) {
  MeasurementLog first(log.origin());
  for (std::size_t k = 1; k < keyframes; ++k) {
    first.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) first.add_registration(z);
  }
  return first;
}

// The textbook filters take a minute for all of intel: its beginning has many more loops than those
// after which a wrong one blows up.
MeasurementLog beginning_of_intel() {
  MeasurementLog log = first_of(read("intel"), 800);
  EXPECT_GT(log.registration_count(), 300U);
  return log;
}

TEST(FiltersOnIntel, EkfEqualsTheTextbookFilter) {
  FATHOM_REQUIRE_DATA(graph("intel"));
  const MeasurementLog log = beginning_of_intel();
  const auto ekf = solved("ekf", log);
  EXPECT_LT(largest_distance(poses_of(*ekf), test::run_naive(test::NaiveEkf(log), log)), 1e-3);
}

TEST(FiltersOnIntel, TrajectoryIekfEqualsTheTextbookFilter) {
  FATHOM_REQUIRE_DATA(graph("intel"));
  const MeasurementLog log = beginning_of_intel();
  const auto iekf = solved("trajectory_iekf", log, test::values({{"max_iterations", "1"}}));
  EXPECT_LT(
      largest_distance(poses_of(*iekf), test::run_naive(test::NaiveTrajectoryIekf(log, 1), log)),
      1e-3);
}

}  // namespace
}  // namespace fathom
