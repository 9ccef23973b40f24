// invariant_ekf and first_estimates_ekf against naive dense ones, and what sets them apart.

#include <gtest/gtest.h>

#include "estimators/invariant_ekf/invariant_ekf.hpp"
#include "fathom/measurements/g2o.hpp"
#include "src/harness/conformance/world_logs.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/naive_error_filters.hpp"
#include "tests/support/data.hpp"

namespace fathom::test {
namespace {

template <class Naive>
void expect_same(const std::string& name, const MeasurementLog& log) {
  const auto estimator = solved(name, log);
  Naive naive(log);
  for (std::size_t k = 1; k < log.size(); ++k) {
    naive.add_keyframe(log.arrival(k).step);
    if (!log.arrival(k).registrations.empty()) naive.close_loops(log.arrival(k).registrations);
  }
  EXPECT_LT(largest_distance(poses_of(*estimator), naive.trajectory()), 1e-6) << name;
  EXPECT_LT(largest_turn(poses_of(*estimator), naive.trajectory()), 1e-6) << name;
  for (std::size_t k = 0; k < log.size(); k += 7) {
    const Eigen::Matrix3d expected = naive.covariance(k);
    EXPECT_LT((*estimator->covariance(k) - expected).norm(), 1e-6 * expected.norm() + 1e-15)
        << name << " " << k;
  }
}

void expect_both(const MeasurementLog& log) {
  expect_same<NaiveInvariantEkf>("invariant_ekf", log);
  expect_same<NaiveFirstEstimatesEkf>("first_estimates_ekf", log);
}

// Twice round a circle far from the origin, headings through ±π, full covariances, loops in both
// directions and several at once.
TEST(ErrorFilters, AreTheNaiveOnesOnACircle) {
  WorldOptions options;
  options.heading_every = 0;
  options.position_every = 0;
  options.start = StartPose({100.0, -200.0, -3.0});
  const MeasurementLog log = circle_in_world(options);
  EXPECT_GT(log.registration_count(), 5u);
  expect_both(log);
}

class ErrorFiltersOnRealLog : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(PoseGraphs, ErrorFiltersOnRealLog, testing::Values("ring", "CSAIL"));

TEST_P(ErrorFiltersOnRealLog, AreTheNaiveOnes) {
  FATHOM_REQUIRE_DATA("pose_graphs/" + GetParam() + ".g2o");
  expect_both(read_g2o(data_path("pose_graphs/" + GetParam() + ".g2o")));
}

TEST(InvariantEkf, ExponentialIsThatOfMatrices) {
  for (const double phi : {0.0, 1e-9, -3e-5, 0.99e-4, 1.01e-4, 0.3, -2.0, 3.1, 3.3, -7.0}) {
    const Eigen::Vector3d twist{1.7, -40.0, phi};
    const Pose expected = pose_of(matrix_exponential(twist));
    const Pose result = exponential(twist);
    EXPECT_NEAR(result.x, expected.x, 1e-12 * 40.0) << phi;
    EXPECT_NEAR(result.y, expected.y, 1e-12 * 40.0) << phi;
    EXPECT_NEAR(wrap_angle(result.theta - expected.theta), 0.0, 1e-12) << phi;
  }
}

// What no loop measures, a turn of the whole map, must stay unknown. The plain filter's Jacobians
// are at different estimates, and its heading at the start, free but for a wide prior, becomes
// known; the others keep it.
TEST(ErrorFilters, NoLoopTellsTheHeadingOfTheMap) {
  WorldOptions options;
  options.heading_every = 0;
  options.position_every = 0;
  const double sigma_rad = 0.2;
  options.start = uncertain_start({1.0, 2.0, -3.0}, 1e-3, sigma_rad);
  const MeasurementLog log = circle_in_world(options);
  const auto heading_sigma = [&](const std::string& name) {
    return std::sqrt((*solved(name, log)->covariance(0))(2, 2));
  };
  EXPECT_LT(heading_sigma("ekf"), 0.999 * sigma_rad);
  EXPECT_NEAR(heading_sigma("invariant_ekf"), sigma_rad, 1e-6 * sigma_rad);
  EXPECT_NEAR(heading_sigma("first_estimates_ekf"), sigma_rad, 1e-6 * sigma_rad);
}

}  // namespace
}  // namespace fathom::test
