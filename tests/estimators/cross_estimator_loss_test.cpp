// The graphs with the same robust loss, keyframe by keyframe, on logs with a few wrong loops: they
// minimise the same cost.

#include <algorithm>

#include <gtest/gtest.h>

#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/spoil.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/support/data.hpp"

namespace fathom {
namespace {

using test::largest_distance;

// The cost as docs/robustness.md has it, of whole poses.
double robust_cost(const MeasurementLog& log, const std::vector<Pose>& poses,
                   const Estimator& estimator) {
  double cost = 0.0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    cost += chi2(log.arrival(k).step, poses[k - 1], poses[k]);
    for (const RelativePose& z : log.arrival(k).registrations) {
      cost += estimator.loss(chi2(z, poses[z.from], poses[z.to]));
    }
  }
  return cost;
}

MeasurementLog with_false_loops(const MeasurementLog& log, double share, std::uint64_t seed) {
  const auto clean = test::make("sparse_gauss_newton", log.origin(), {}, SolveMode::batch);
  test::feed(*clean, log);
  return spoil(log, poses_of(*clean), {.share = share}, seed).log;
}

struct Agreement {
  double cost_share = 1e-9;
  double distance_m = 1e-5;
  double weight = 1e-4;
};

void expect_agreement(const MeasurementLog& log, const std::string& loss,
                      const std::vector<std::string>& others, const Agreement& within) {
  const auto ours = test::solved("incremental_smoother", log, test::exactly_with(loss));
  const std::vector<Pose> poses = poses_of(*ours);
  const double cost = robust_cost(log, poses, *ours);
  for (const std::string& name : others) {
    const auto other = test::solved(name, log, test::exactly_with(loss));
    const std::vector<Pose> theirs = poses_of(*other);
    EXPECT_NEAR(robust_cost(log, theirs, *ours) / cost, 1.0, within.cost_share) << name << loss;
    EXPECT_LT(largest_distance(poses, theirs), within.distance_m) << name << loss;
    const std::vector<double> our_weights = ours->loop_weights();
    const std::vector<double> their_weights = other->loop_weights();
    ASSERT_EQ(our_weights.size(), log.registration_count());
    ASSERT_EQ(their_weights.size(), our_weights.size());
    for (std::size_t j = 0; j < our_weights.size(); ++j) {
      EXPECT_NEAR(our_weights[j], their_weights[j], within.weight) << name << loss << j;
    }
  }
}

class CrossEstimatorLoss : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(Losses, CrossEstimatorLoss,
                         testing::Values("huber", "cauchy", "geman_mcclure", "dcs"),
                         [](const auto& name) { return name.param; });

TEST_P(CrossEstimatorLoss, TheGraphsAgreeOnACircle) {
  for (const std::size_t loop_every : {5, 2}) {
    test::LogOptions options;
    options.keyframes = 60;
    options.loop_every = loop_every;
    const MeasurementLog log = with_false_loops(test::circle_log(options), 0.1, 3);
    expect_agreement(log, GetParam(), {"sparse_gauss_newton", "ceres_pose_graph"}, {});
  }
}

// Their long ways without loops are soft: F says little of them.
TEST_P(CrossEstimatorLoss, TheGraphsAgreeOnRing) {
  FATHOM_REQUIRE_DATA("pose_graphs/ring.g2o");
  const MeasurementLog log =
      with_false_loops(read_g2o(test::data_path("pose_graphs/ring.g2o")), 0.1, 2);
  expect_agreement(log, GetParam(), {"sparse_gauss_newton", "ceres_pose_graph"},
                   {1e-8, 1e-2, 1e-4});
}

TEST_P(CrossEstimatorLoss, TheGraphsAgreeOnCsail) {
  FATHOM_REQUIRE_DATA("pose_graphs/CSAIL.g2o");
  const MeasurementLog log =
      with_false_loops(read_g2o(test::data_path("pose_graphs/CSAIL.g2o")), 0.1, 2);
  expect_agreement(log, GetParam(), {"sparse_gauss_newton"}, {1e-8, 1e-3, 1e-4});
}

// Headings and positions: information of rank 1 and 2, of which some are far off.
TEST_P(CrossEstimatorLoss, TheGraphsAgreeOnAbsoluteMeasurements) {
  const MeasurementLog loops = test::circle_log({});
  const std::vector<Pose> truth = test::circle(loops.size());
  RandomStream random(7, "absolute");
  MeasurementLog log;
  for (std::size_t k = 1; k < loops.size(); ++k) {
    log.add_keyframe(loops.arrival(k).step);
    for (const RelativePose& z : loops.arrival(k).registrations) log.add_registration(z);
    const double jump_rad = k % 9 == 0 ? 0.4 : 0.0;
    log.add_absolute(AbsolutePose::heading(
        k, wrap_angle(truth[k].theta + jump_rad + 0.02 * random.normal()), 0.02));
    if (k % 4 != 0) continue;
    const double jump_m = k % 16 == 0 ? 20.0 : 0.0;
    log.add_absolute(AbsolutePose::position(
        k, truth[k].position() + Eigen::Vector2d(0.5 * random.normal() + jump_m, 0.0),
        0.25 * Eigen::Matrix2d::Identity()));
  }
  const auto ours = test::solved("incremental_smoother", log, test::exactly_with(GetParam()));
  const std::vector<double> our_weights = ours->absolute_weights();
  ASSERT_EQ(our_weights.size(), log.absolute_count());
  EXPECT_LT(*std::ranges::min_element(our_weights), 0.5);
  for (const std::string name : {"sparse_gauss_newton", "ceres_pose_graph"}) {
    const auto other = test::solved(name, log, test::exactly_with(GetParam()));
    EXPECT_LT(largest_distance(poses_of(*ours), poses_of(*other)), 1e-5) << name;
    EXPECT_EQ(ours->loss(9.0, 1), other->loss(9.0, 1));
    const std::vector<double> weights = other->absolute_weights();
    ASSERT_EQ(weights.size(), our_weights.size());
    for (std::size_t j = 0; j < weights.size(); ++j) EXPECT_NEAR(our_weights[j], weights[j], 1e-4);
  }
}

TEST_P(CrossEstimatorLoss, TheSmootherIsNearThatCostByDefault) {
  test::LogOptions options;
  options.keyframes = 100;
  const MeasurementLog log = with_false_loops(test::circle_log(options), 0.1, 4);
  const EstimatorValues values = test::values({{"loss", GetParam()}});
  const auto ours = test::solved("incremental_smoother", log, values);
  const auto whole = test::solved("sparse_gauss_newton", log, values);
  const double optimum = robust_cost(log, poses_of(*whole), *whole);
  EXPECT_LT(robust_cost(log, poses_of(*ours), *ours), 1.001 * optimum);
  EXPECT_EQ(ours->loss(30.0), whole->loss(30.0));
}

}  // namespace
}  // namespace fathom
