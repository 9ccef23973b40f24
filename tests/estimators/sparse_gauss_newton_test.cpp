// sparse_gauss_newton: its starts, its reports, and its optimum and covariances against those of
// Ceres.

#include "estimators/sparse_gauss_newton/sparse_gauss_newton.hpp"

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/batch.hpp"
#include "estimators/support/pose_graph/lifted_headings.hpp"
#include "fathom/measurements/g2o.hpp"
#include "tests/estimators/graph_parts.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/support/data.hpp"

namespace fathom {
namespace {

using namespace pose_graph;  // NOLINT: its parts are what is tested
using test::LogOptions;

struct Batch {
  std::unique_ptr<Estimator> estimator;
  UpdateReport report;
};

Batch batch(const MeasurementLog& log, const std::string& type, const EstimatorValues& values = {},
            std::span<const Pose> start = {}) {
  Batch result;
  result.estimator =
      builtin_estimators().find(type).create({log.origin(), SolveMode::batch}, values);
  for (std::size_t k = 1; k < log.size(); ++k) {
    result.estimator->add_keyframe(log.arrival(k).step);
    result.estimator->update({log.arrival(k).registrations});
  }
  result.report = result.estimator->finish(start);
  return result;
}

double cost(const MeasurementLog& log, const Batch& batch) {
  return chi2(log, poses_of(*batch.estimator));
}

EstimatorValues start_at(const std::string& start) {
  return test::values({{"start", start}});
}

TEST(SparseGaussNewton, FindsTheOptimumAndCovariancesOfCeres) {
  for (const double noise : {1.0, 4.0}) {
    LogOptions options;
    options.keyframes = 60;
    options.noise = noise;
    options.origin = {3.0, -7.0, 3.0};
    const MeasurementLog log = test::circle_log(options);
    const Batch ceres = batch(log, "ceres_pose_graph", test::values({{"tolerance", "1e-14"}}));
    for (const std::string start : {"auto", "given", "lago", "chordal", "lifted"}) {
      const Batch ours = batch(log, "sparse_gauss_newton", start_at(start));
      EXPECT_EQ(ours.report.outcome, Outcome::converged);
      EXPECT_EQ(ours.report.is_local_minimum, true);
      EXPECT_LT(ours.report.gradient_norm.value(), 1.0);
      EXPECT_NEAR(cost(log, ours), cost(log, ceres), 1e-6 * cost(log, ceres));
      for (std::size_t k = 1; k < log.size(); ++k) {
        const Eigen::Matrix3d C = *ceres.estimator->covariance(k);
        EXPECT_LT((*ours.estimator->covariance(k) - C).norm(), 1e-5 * C.norm()) << start;
      }
    }
  }
}

TEST(SparseGaussNewton, UsesRepeatedAndBackwardEdges) {
  MeasurementLog log = test::circle_log({});
  const std::size_t last = log.size() - 1;
  const RelativePose z = log.edges().back();
  for (int i = 0; i < 2; ++i) log.add_registration({4, last, z.motion, z.information, {}});
  log.add_registration({last, 9, {-1.0, 0.2, 0.3}, z.information, {}});
  log.add_registration({0, last, {1.0, 0.2, 0.3}, z.information, {}});
  const Batch ceres = batch(log, "ceres_pose_graph", test::values({{"tolerance", "1e-14"}}));
  const Batch ours = batch(log, "sparse_gauss_newton", start_at("given"));
  EXPECT_TRUE(is_done(ours.report.outcome));
  EXPECT_NEAR(cost(log, ours), cost(log, ceres), 1e-6 * cost(log, ceres));
}

TEST(SparseGaussNewton, WithoutLoopsDeadReckoningIsTheOptimum) {
  LogOptions options;
  options.loop_every = 0;
  const MeasurementLog log = test::circle_log(options);
  const Batch ours = batch(log, "sparse_gauss_newton");
  EXPECT_EQ(ours.report.outcome, Outcome::converged);
  EXPECT_LT(test::largest_distance(poses_of(*ours.estimator), log.odometry()), 1e-9);
  const MeasurementLog alone;
  EXPECT_EQ(batch(alone, "sparse_gauss_newton").report.outcome, Outcome::converged);
}

// An arm of two links, stretched along +x, whose end is asked to be at −x: it could fold to either
// side, and for reasons of symmetry no step does.
TEST(SparseGaussNewton, SaysThatASaddleIsNoMinimum) {
  MeasurementLog log;
  const Eigen::Matrix3d stiff = Eigen::Vector3d(100.0, 100.0, 0.1).asDiagonal();
  const Eigen::Matrix3d loop = Eigen::Vector3d(100.0, 100.0, 1e-3).asDiagonal();
  for (std::size_t k = 1; k <= 3; ++k) log.add_keyframe({k - 1, k, {1.0, 0.0, 0.0}, stiff, {}});
  log.add_registration({0, 3, {-2.0, 0.0, 0.0}, loop, {}});
  const Batch straight = batch(log, "sparse_gauss_newton", start_at("given"));
  EXPECT_EQ(straight.report.outcome, Outcome::converged);
  EXPECT_LT(straight.report.gradient_norm.value(), 1e-6);
  EXPECT_EQ(straight.report.is_local_minimum, false);
  std::vector<Pose> bent = log.odometry();
  bent[2].theta = 0.3;
  const Batch folded = batch(log, "sparse_gauss_newton", start_at("given"), bent);
  EXPECT_EQ(folded.report.is_local_minimum, true);
  EXPECT_LT(cost(log, folded), 0.9 * cost(log, straight));
}

// Parallel tracks with headings so noisy that dead reckoning turns by whole rounds.
MeasurementLog dizzy_survey(double sigma_rad, std::uint64_t seed, std::vector<Pose>& truth) {
  constexpr std::size_t kAlong = 30;
  constexpr std::size_t kTracks = 8;
  RandomStream random(seed, "dizzy");
  const auto pose_at = [](std::size_t k) {
    const std::size_t track = k / kAlong;
    const std::size_t x = track % 2 == 1 ? kAlong - 1 - k % kAlong : k % kAlong;
    return Pose{double(x), double(track), track % 2 == 1 ? M_PI : 0.0};
  };
  truth = {pose_at(0)};
  MeasurementLog log(truth[0]);
  const Eigen::Matrix3d C = Eigen::Vector3d(0.02, 0.02, sigma_rad * sigma_rad).asDiagonal();
  const auto measure = [&](std::size_t from, std::size_t to) {
    const Pose motion = between(truth[from], truth[to]);
    return RelativePose::from_covariance(from, to, test::perturbed(motion, 0.02, sigma_rad, random),
                                         C);
  };
  for (std::size_t k = 1; k < kAlong * kTracks; ++k) {
    truth.push_back(pose_at(k));
    log.add_keyframe(measure(k - 1, k));
    if (k >= kAlong) log.add_registration(measure(k - (2 * (k % kAlong) + 1), k));
  }
  return log;
}

TEST(SparseGaussNewton, AutoUnwindsWhatLagoRoundsWrongly) {
  int lago_failed = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    std::vector<Pose> truth;
    const MeasurementLog log = dizzy_survey(0.35, seed, truth);
    const Batch from_truth = batch(log, "sparse_gauss_newton", start_at("given"), truth);
    ASSERT_EQ(from_truth.report.is_local_minimum, true);
    const double least = cost(log, from_truth);
    const Batch automatic = batch(log, "sparse_gauss_newton");
    EXPECT_EQ(automatic.report.outcome, Outcome::converged);
    EXPECT_EQ(automatic.report.is_local_minimum, true);
    EXPECT_LT(cost(log, automatic), least * (1.0 + 1e-6)) << "seed " << seed;
    const Batch lago = batch(log, "sparse_gauss_newton", start_at("lago"));
    lago_failed += cost(log, lago) > 1.1 * least ? 1 : 0;
  }
  EXPECT_GE(lago_failed, 3);
}

TEST(SparseGaussNewton, LiftedHeadingsDoNotDependOnTheirStart) {
  std::vector<Pose> truth;
  const MeasurementLog log = dizzy_survey(0.3, 9, truth);
  const std::vector<Edge> edges = test::parts_of(log).edges;
  const sparse::Symbolic symbolic = analyse_graph(edges, static_cast<int>(log.size()));
  std::vector<double> zero(log.size(), truth[0].theta);
  std::vector<double> right;
  for (const Pose& pose : truth) right.push_back(pose.theta);
  const std::vector<double> a = lifted_headings(symbolic, edges, zero);
  const std::vector<double> b = lifted_headings(symbolic, edges, right);
  for (std::size_t k = 0; k < a.size(); ++k) {
    EXPECT_LT(std::abs(wrap_angle(a[k] - b[k])), 0.05);
  }
}

TEST(SparseGaussNewton, RefusesOptionsWithoutEffect) {
  const EstimatorEntry& entry = builtin_estimators().find("sparse_gauss_newton");
  EXPECT_THROW(entry.create({{}, SolveMode::batch}, test::values({{"gate_probability", "0.99"}})),
               InputError);
  EXPECT_THROW(entry.create({{}, SolveMode::incremental}, start_at("lago")), InputError);
  EXPECT_THROW(entry.create({{}, SolveMode::batch}, start_at("luck")), InputError);
}

TEST(SparseGaussNewton, StopsAtItsLimitAndSaysSo) {
  LogOptions options;
  options.noise = 4.0;
  const MeasurementLog log = test::circle_log(options);
  const Batch ours = batch(log, "sparse_gauss_newton",
                           test::values({{"max_iterations", "1"}, {"start", "given"}}));
  EXPECT_EQ(ours.report.outcome, Outcome::iteration_limit);
  EXPECT_EQ(ours.report.iterations, 1);
  EXPECT_LT(cost(log, ours), chi2(log, log.odometry()));
}

struct Optimum {
  std::string name;
  double chi2;
};

class SparseGaussNewtonOptimum : public testing::TestWithParam<Optimum> {};

// Optima found by independent solvers (g2o, GTSAM, Ceres), as recorded with the data.
INSTANTIATE_TEST_SUITE_P(PoseGraphs, SparseGaussNewtonOptimum,
                         testing::Values(Optimum{"intel", 45.0047}, Optimum{"CSAIL", 40.5551},
                                         Optimum{"manhattan", 3549.0368}, Optimum{"MIT", 41.16},
                                         Optimum{"M3500", 137.913}, Optimum{"M3500a", 912.115},
                                         Optimum{"M3500b", 2054.72}, Optimum{"M3500c", 2554.73},
                                         Optimum{"ring", 11.1631}),
                         [](const auto& optimum) { return optimum.param.name; });

TEST_P(SparseGaussNewtonOptimum, IsReachedWithoutHelp) {
  const std::string file = "pose_graphs/" + GetParam().name + ".g2o";
  FATHOM_REQUIRE_DATA(file);
  const MeasurementLog log = read_g2o(test::data_path(file));
  const Batch ours = batch(log, "sparse_gauss_newton");
  EXPECT_EQ(ours.report.outcome, Outcome::converged);
  EXPECT_EQ(ours.report.is_local_minimum, true);
  EXPECT_NEAR(cost(log, ours), GetParam().chi2, 1e-4 * GetParam().chi2);
}

}  // namespace
}  // namespace fathom
