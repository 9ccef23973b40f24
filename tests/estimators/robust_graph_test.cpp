// sparse_gauss_newton with wrong loops: weights, and the optimum of the right loops found among
// false ones.

#include <cmath>

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/solver.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/spoil.hpp"
#include "tests/estimators/graph_parts.hpp"
#include "tests/support/data.hpp"

namespace fathom {
namespace {

using namespace pose_graph;  // NOLINT: its parts are what is tested
using test::circle_of;
using test::GraphParts;
using test::parts_of;

struct Solved {
  std::vector<Pose> poses;
  std::vector<double> weights;
  UpdateReport report;
};

Solved solve(const MeasurementLog& log, const EstimatorValues& values,
             SolveMode mode = SolveMode::batch) {
  const auto estimator =
      builtin_estimators().find("sparse_gauss_newton").create({log.origin(), mode}, values);
  test::feed(*estimator, log);
  Solved solved{poses_of(*estimator), estimator->loop_weights(), {}};
  return solved;
}

double mean_distance_m(const std::vector<Pose>& a, const std::vector<Pose>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k].position() - b[k].position()).norm();
  return sum / static_cast<double>(a.size());
}

EstimatorValues loss(const std::string& name) {
  return test::values({{"loss", name}});
}

// Textbook reweighting: weights from the residuals, plain least squares with them, again and again.
TEST(RobustGraph, IsWhereReweightingEnds) {
  MeasurementLog log = circle_of(40);
  const std::vector<Pose> clean = solve(log, {}).poses;
  const Spoiled spoiled = spoil(log, clean, {.share = 0.1}, 3);
  const GraphParts parts = parts_of(spoiled.log);
  const sparse::Symbolic symbolic = parts.analysed();
  for (const char* name : {"huber", "cauchy", "dcs", "geman_mcclure"}) {
    const Solved solved = solve(spoiled.log, loss(name));
    LossOptions options;
    OptionTable table;
    options.describe(table);
    table.set("loss", OptionValue::scalar(name));
    const RobustLoss rho(options);
    std::vector<Node> nodes = nodes_of(solved.poses);
    NormalEquations equations(symbolic, parts.edges);
    std::vector<double> weights(parts.edges.size(), 1.0);
    for (int round = 0; round < 3; ++round) {
      std::size_t next = 0;
      for (std::size_t e = 0; e < parts.edges.size(); ++e) {
        if (parts.is_loop[e] == 0) continue;
        const Edge& edge = parts.edges[e];
        weights[e] = rho.weight(linearise_edge(edge, nodes[static_cast<std::size_t>(edge.from)],
                                               nodes[static_cast<std::size_t>(edge.to)])
                                    .cost);
        EXPECT_NEAR(weights[e], solved.weights[next++], 1e-6) << name;
      }
      equations.set_loss({RobustLoss(), {}, weights});
      minimise(equations, nodes, {50, 1e-12});
    }
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      EXPECT_NEAR(nodes[k].x, solved.poses[k].x, 1e-5) << name;
      EXPECT_NEAR(nodes[k].y, solved.poses[k].y, 1e-5) << name;
    }
  }
}

// Loops a thousand times as precise as the drift: at dead reckoning all of them look false.
TEST(RobustGraph, FindsPreciseLoopsAfterALongDrift) {
  const std::vector<Pose> truth = test::circle(100);
  RandomStream random(8, "precise");
  MeasurementLog log;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    log.add_keyframe(RelativePose::from_covariance(
        k - 1, k, test::perturbed(between(truth[k - 1], truth[k]), 0.05, 0.02, random),
        Eigen::Vector3d(0.0025, 0.0025, 0.0004).asDiagonal()));
    if (k < 50 || k % 2 == 0) continue;
    const Eigen::Matrix3d precise = 1e-8 * Eigen::Matrix3d::Identity();
    log.add_registration(RelativePose::from_covariance(
        k - 50, k, test::perturbed(between(truth[k - 50], truth[k]), 1e-4, 1e-4, random), precise));
  }
  const std::vector<Pose> clean = solve(log, {}).poses;
  const Spoiled spoiled = spoil(log, truth, {.share = 0.3}, 1);
  for (const SolveMode mode : {SolveMode::batch, SolveMode::incremental}) {
    const Solved robust = solve(spoiled.log, loss("truncated"), mode);
    EXPECT_LT(mean_distance_m(robust.poses, clean), 1e-3);
    for (std::size_t j = 0; j < robust.weights.size(); ++j) {
      EXPECT_LE(spoiled.is_false[j] ? robust.weights[j] : 0.0, 0.5);
    }
  }
}

// Loops without any error set the least scale; what is left out costs that, and not the default.
TEST(RobustGraph, TheLossIsThatOfTheAdaptedScale) {
  const std::vector<Pose> truth = test::circle(100);
  const Eigen::Matrix3d covariance = 1e-4 * Eigen::Matrix3d::Identity();
  MeasurementLog log;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    log.add_keyframe(
        RelativePose::from_covariance(k - 1, k, between(truth[k - 1], truth[k]), covariance));
    if (k < 50) continue;
    Pose motion = between(truth[k - 50], truth[k]);
    if (k == 70) motion.x += 1.0;
    log.add_registration(RelativePose::from_covariance(k - 50, k, motion, covariance));
  }
  const double by_default = std::pow(default_scale(LossKind::truncated), 2);
  for (const bool is_given : {false, true}) {
    EstimatorValues values = loss("truncated");
    if (is_given) values["loss_scale"] = OptionValue::scalar("3");
    const auto estimator = builtin_estimators()
                               .find("sparse_gauss_newton")
                               .create({log.origin(), SolveMode::batch}, values);
    EXPECT_NEAR(estimator->loss(1e6, 3), is_given ? 9.0 : by_default, 1e-9);
    test::feed(*estimator, log);
    const double scale = is_given ? 9.0 : 0.01 * by_default;
    EXPECT_NEAR(estimator->loss(1e6, 3), scale, 1e-9);
    EXPECT_EQ(estimator->loss(0.5 * scale, 3), 0.5 * scale);
    // Of other measurements the default, whatever registrations agree on.
    const double partial = is_given ? 9.0 : by_default;
    EXPECT_NEAR(estimator->loss(1e6, 2), partial * squared_scale_share(LossKind::truncated, 2),
                1e-9);
    EXPECT_EQ(estimator->loop_weights()[20], 0.0);
  }
}

TEST(RobustGraph, FindsTheRightLoopsAmongFalseOnes) {
  const MeasurementLog log = circle_of(200);
  const std::vector<Pose> clean = solve(log, {}).poses;
  for (const FalseLoopKind kind :
       {FalseLoopKind::random, FalseLoopKind::local, FalseLoopKind::grouped}) {
    const Spoiled spoiled = spoil(log, test::circle(200), {.share = 0.3, .kind = kind}, 1);
    const Solved robust = solve(spoiled.log, loss("truncated"));
    EXPECT_GT(mean_distance_m(solve(spoiled.log, {}).poses, clean), 1.0) << name_of(kind);
    EXPECT_LT(mean_distance_m(robust.poses, clean), 0.02) << name_of(kind);
    ASSERT_EQ(robust.weights.size(), spoiled.is_false.size());
    std::size_t lost = 0;
    for (std::size_t j = 0; j < robust.weights.size(); ++j) {
      if (spoiled.is_false[j]) {
        EXPECT_LE(robust.weights[j], 0.5) << name_of(kind);
      } else if (robust.weights[j] <= 0.5) {
        ++lost;
      }
    }
    EXPECT_LE(lost, 2u);
  }
}

// And as it goes, with the estimate of every keyframe.
TEST(RobustGraph, AlsoIncrementally) {
  const MeasurementLog log = circle_of(100);
  const Spoiled spoiled = spoil(log, test::circle(100), {.share = 0.3}, 2);
  const std::vector<Pose> clean = solve(log, {}).poses;
  const Solved robust = solve(spoiled.log, loss("truncated"), SolveMode::incremental);
  EXPECT_LT(mean_distance_m(robust.poses, clean), 0.03);
  for (std::size_t j = 0; j < robust.weights.size(); ++j) {
    EXPECT_LE(spoiled.is_false[j] ? robust.weights[j] : 0.0, 0.5);
  }
}

TEST(RobustGraph, RingWithAThirdOfItsLoopsFalse) {
  FATHOM_REQUIRE_DATA("pose_graphs/ring.g2o");
  const MeasurementLog log = read_g2o(test::data_path("pose_graphs/ring.g2o"));
  const std::vector<Pose> clean = solve(log, {}).poses;
  for (const FalseLoopKind kind :
       {FalseLoopKind::random, FalseLoopKind::local, FalseLoopKind::grouped}) {
    const Spoiled spoiled = spoil(log, clean, {.share = 0.3, .kind = kind}, 1);
    const Solved robust = solve(spoiled.log, loss("truncated"));
    EXPECT_GT(mean_distance_m(solve(spoiled.log, {}).poses, clean), 1.0);
    EXPECT_LT(mean_distance_m(robust.poses, clean), 0.05);
    for (std::size_t j = 0; j < robust.weights.size(); ++j) {
      EXPECT_EQ(robust.weights[j] > 0.5, !spoiled.is_false[j]) << j;
    }
  }
}

TEST(RobustGraph, WithoutFalseLoopsItIsLeastSquares) {
  const MeasurementLog log = circle_of(60);
  const std::vector<Pose> plain = solve(log, {}).poses;
  const Solved robust = solve(log, loss("truncated"));
  EXPECT_LT(mean_distance_m(robust.poses, plain), 0.01);
  // Measurements that agree exactly are no reason to distrust any.
  const Solved exact = solve(circle_of(60, 0.0), loss("truncated"));
  for (const double weight : exact.weights) EXPECT_EQ(weight, 1.0);
}

TEST(RobustGraph, WeightsStandInTheOrderOfTheRegistrations) {
  MeasurementLog log = circle_of(40);
  const auto estimator =
      builtin_estimators()
          .find("sparse_gauss_newton")
          .create({log.origin()}, test::values({{"gate_probability", "0.999"}, {"loss", "huber"}}));
  std::vector<LoopDecision> loops;
  log.add_registration(
      RelativePose::from_covariance(3, 39, {50.0, 0.0, 0.0}, test::full_covariance(0.01, 0.005)));
  test::feed(*estimator, log, &loops);
  const std::vector<double> weights = estimator->loop_weights();
  ASSERT_EQ(weights.size(), loops.size());
  for (std::size_t j = 0; j < loops.size(); ++j) {
    EXPECT_EQ(weights[j] == 0.0, loops[j].fate == LoopFate::rejected);
  }
  EXPECT_EQ(weights.back(), 0.0);
  EXPECT_GT(weights.front(), 0.0);
}

// Every number of the judgement is an option: a later end of the ramp leaves more weight.
TEST(RobustGraph, TheJudgementIsTuned) {
  const MeasurementLog log = circle_of(60);
  const auto kept = [&](EstimatorValues values) {
    values.merge(test::values({{"loss", "truncated"}, {"loss_scale", "1.5"}}));
    double sum = 0.0;
    for (const double weight : solve(log, values).weights) sum += weight;
    return sum;
  };
  EXPECT_EQ(kept(test::values({{"truncated.reject_at", "1.5"}})), kept({}));
  EXPECT_GT(kept(test::values({{"truncated.reject_at", "2"}})), kept({}) + 1.0);
}

TEST(RobustGraph, RefusesWhatWouldHaveNoEffect) {
  const auto refuses = [](const EstimatorValues& values, SolveMode mode) {
    EXPECT_THROW(builtin_estimators().find("sparse_gauss_newton").create({{}, mode}, values),
                 InputError);
  };
  refuses(test::values({{"loss_scale", "2"}}), SolveMode::batch);
  refuses(test::values({{"loss", "huber"}, {"graduation", "convex"}}), SolveMode::batch);
  refuses(test::values({{"loss", "huber"}, {"start", "lago"}}), SolveMode::batch);
  refuses(test::values({{"loss", "huber"}, {"truncated.reject_at", "1.6"}}), SolveMode::batch);
  EXPECT_THROW(builtin_estimators().find("ceres_pose_graph").create({}, loss("truncated")),
               InputError);
}

}  // namespace
}  // namespace fathom
