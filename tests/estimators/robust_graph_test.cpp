// sparse_gauss_newton with wrong loops: weights, tests of loops and of groups, and the optimum of
// the right loops found among false ones.

#include <cmath>

#include <gtest/gtest.h>

#include "estimators/sparse_gauss_newton/drift.hpp"
#include "estimators/sparse_gauss_newton/leave_one_out.hpp"
#include "estimators/sparse_gauss_newton/loop_groups.hpp"
#include "estimators/sparse_gauss_newton/robust.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/spoil.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/support/data.hpp"

namespace fathom {
namespace {

using namespace sparse_gauss_newton;  // NOLINT: its parts are what is tested
using pose_graph::nodes_of;

struct Parts {
  std::vector<Edge> edges;
  std::vector<char> is_loop;
  std::vector<Node> nodes;
};

Parts parts_of(const MeasurementLog& log) {
  Parts parts;
  for (std::size_t k = 1; k < log.size(); ++k) {
    parts.edges.push_back(make_edge(log.arrival(k).step));
    parts.is_loop.push_back(0);
    for (const RelativePose& z : log.arrival(k).registrations) {
      parts.edges.push_back(make_edge(z));
      parts.is_loop.push_back(1);
    }
  }
  parts.nodes = nodes_of(log.odometry());
  return parts;
}

MeasurementLog circle(std::size_t keyframes, double noise = 1.0) {
  test::LogOptions options;
  options.keyframes = keyframes;
  options.noise = noise;
  return test::circle_log(options);
}

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

// Gradient and Hessian of Σ ρ against differences of it, weights included.
TEST(RobustDerivatives, AreThoseOfTheCost) {
  const Parts parts = parts_of(circle(12, 10.0));
  const sparse::Symbolic symbolic =
      analyse_graph(parts.edges, static_cast<int>(parts.nodes.size()));
  std::vector<double> weights(parts.edges.size(), 1.0);
  weights.back() = 0.3;
  weights[3] = 0.0;
  for (const LossKind kind :
       {LossKind::huber, LossKind::cauchy, LossKind::geman_mcclure, LossKind::dcs}) {
    NormalEquations equations(symbolic, parts.edges);
    equations.set_loss({RobustLoss(kind, 4.0), parts.is_loop, weights});
    const auto moved = [&](std::size_t k, int element, double by) {
      std::vector<Node> nodes = parts.nodes;
      Node& n = nodes[k];
      n = make_node(n.x + (element == 0 ? by : 0.0), n.y + (element == 1 ? by : 0.0),
                    n.theta + (element == 2 ? by : 0.0));
      return nodes;
    };
    const auto cost = [&](const std::vector<Node>& nodes) {
      return equations.linearise(nodes, Hessian::exact);
    };
    // Two derivatives: the slope of F, and how the gradient changes along a direction.
    std::vector<double> direction(3 * (parts.nodes.size() - 1));
    for (std::size_t i = 0; i < direction.size(); ++i) {
      direction[i] = std::sin(1.0 + static_cast<double>(i));
    }
    const auto along = [&](double by) {
      std::vector<Node> nodes = parts.nodes;
      for (std::size_t k = 1; k < nodes.size(); ++k) {
        const auto p = static_cast<std::size_t>(symbolic.position[k - 1]);
        nodes[k] =
            make_node(nodes[k].x + by * direction[3 * p], nodes[k].y + by * direction[3 * p + 1],
                      nodes[k].theta + by * direction[3 * p + 2]);
      }
      return nodes;
    };
    constexpr double kStep = 1e-6;
    cost(parts.nodes);
    const std::vector<double> gradient = equations.gradient();
    for (const std::size_t k : {std::size_t{1}, std::size_t{6}, std::size_t{11}}) {
      for (int element = 0; element < 3; ++element) {
        const double slope =
            (cost(moved(k, element, kStep)) - cost(moved(k, element, -kStep))) / (2.0 * kStep);
        const auto p = static_cast<std::size_t>(3 * symbolic.position[k - 1] + element);
        EXPECT_NEAR(2.0 * gradient[p], slope, 1e-5 * (1.0 + std::abs(slope)));
      }
    }
    // H⁻¹ of the change of the gradient along a direction is that direction.
    cost(along(kStep));
    std::vector<double> change = equations.gradient();
    cost(along(-kStep));
    for (std::size_t i = 0; i < change.size(); ++i) {
      change[i] = (change[i] - equations.gradient()[i]) / (2.0 * kStep);
    }
    cost(parts.nodes);
    ASSERT_TRUE(equations.factorise());
    equations.solve(change.data());
    for (std::size_t i = 0; i < change.size(); ++i) EXPECT_NEAR(change[i], direction[i], 1e-4);
  }
}

// Textbook reweighting: weights from the residuals, plain least squares with them, again and again.
TEST(RobustGraph, IsWhereReweightingEnds) {
  MeasurementLog log = circle(40);
  const std::vector<Pose> clean = solve(log, {}).poses;
  const Spoiled spoiled = spoil(log, clean, {.share = 0.1}, 3);
  const Parts parts = parts_of(spoiled.log);
  const sparse::Symbolic symbolic =
      analyse_graph(parts.edges, static_cast<int>(parts.nodes.size()));
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

// By how much F falls without a loop, its own part aside, by solving again without it. With little
// noise, as the test is linear.
TEST(LeaveOneOut, IsWhatALoopCosts) {
  const Parts parts = parts_of(circle(30, 0.1));
  const sparse::Symbolic symbolic =
      analyse_graph(parts.edges, static_cast<int>(parts.nodes.size()));
  NormalEquations equations(symbolic, parts.edges);
  const auto least = [&](const std::vector<double>& weights, std::vector<Node>& nodes) {
    equations.set_loss({RobustLoss(), {}, weights});
    return minimise(equations, nodes, {50, 1e-14}).cost;
  };
  const std::vector<double> all(parts.edges.size(), 1.0);
  std::vector<Node> nodes = parts.nodes;
  const double with_all = least(all, nodes);
  const std::vector<double> chi2 = leave_one_out(equations, parts.is_loop, all, nodes);
  std::size_t checked = 0;
  for (std::size_t e = 0; e < parts.edges.size(); ++e) {
    if (parts.is_loop[e] == 0) {
      EXPECT_EQ(chi2[e], 0.0);
      continue;
    }
    std::vector<double> weights = all;
    weights[e] = 0.0;
    std::vector<Node> without = nodes;
    const double rise = with_all - least(weights, without);
    EXPECT_NEAR(chi2[e], rise, 0.02 * rise + 1e-6) << e;
    // Outside, or half in, it is judged by the same others.
    EXPECT_NEAR(leave_one_out(equations, parts.is_loop, weights, without)[e], rise, 0.02 * rise);
    weights[e] = 0.4;
    least(weights, without);
    EXPECT_NEAR(leave_one_out(equations, parts.is_loop, weights, without)[e], rise, 0.02 * rise);
    ++checked;
  }
  EXPECT_GT(checked, 5u);
}

TEST(GroupChi2, OfOneLoopIsLeaveOneOut) {
  const Parts parts = parts_of(circle(30, 0.1));
  const sparse::Symbolic symbolic =
      analyse_graph(parts.edges, static_cast<int>(parts.nodes.size()));
  NormalEquations equations(symbolic, parts.edges);
  const std::vector<double> all(parts.edges.size(), 1.0);
  std::vector<Node> nodes = parts.nodes;
  minimise(equations, nodes, {50, 1e-14});
  const std::vector<double> chi2 = leave_one_out(equations, parts.is_loop, all, nodes);
  for (std::size_t e = 0; e < parts.edges.size(); ++e) {
    if (parts.is_loop[e] == 0) continue;
    EXPECT_NEAR(group_chi2(equations, {e}, all, nodes), chi2[e], 1e-6 * (1.0 + chi2[e]));
  }
}

// A group that agrees within itself: none of its loops contradicts the rest, all together do.
TEST(GroupChi2, SeesWhatLeavingOneOutDoesNot) {
  MeasurementLog log;
  const Eigen::Matrix3d step = Eigen::Vector3d(0.01, 0.01, 0.0004).asDiagonal();
  const Eigen::Matrix3d loop = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  for (std::size_t k = 1; k <= 12; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.0, 0.0, 0.0}, step));
    // Off by 3 m, all three.
    if (k >= 10) log.add_registration(RelativePose::from_covariance(k - 9, k, {6, 0, 0}, loop));
  }
  Parts parts = parts_of(log);
  const sparse::Symbolic symbolic =
      analyse_graph(parts.edges, static_cast<int>(parts.nodes.size()));
  NormalEquations equations(symbolic, parts.edges);
  const std::vector<double> all(parts.edges.size(), 1.0);
  minimise(equations, parts.nodes, {50, 1e-12});
  const std::vector<double> chi2 = leave_one_out(equations, parts.is_loop, all, parts.nodes);
  std::vector<std::size_t> group;
  for (std::size_t e = 0; e < parts.edges.size(); ++e) {
    if (parts.is_loop[e] != 0) group.push_back(e);
  }
  for (const std::size_t e : group) EXPECT_LT(chi2[e], 16.0);
  // About 3² / (7 · 0.01): the steps that all three span, and a part of the others.
  EXPECT_GT(group_chi2(equations, group, all, parts.nodes), 80.0);
}

// Against the steps composed one by one.
TEST(Drift, IsThatOfTheStepsComposed) {
  const MeasurementLog log = circle(40);
  const Parts parts = parts_of(log);
  const Drift drift(parts.edges, parts.is_loop, parts.nodes);
  for (const auto& [from, to] :
       {std::pair<std::size_t, std::size_t>{0, 39}, {7, 8}, {11, 30}, {30, 31}}) {
    std::vector<UncertainPose> steps;
    for (std::size_t k = from + 1; k <= to; ++k) {
      const RelativePose& step = log.arrival(k).step;
      steps.push_back({step.motion, step.covariance()});
    }
    const UncertainPose composed = compose_chain(steps);
    const Edge edge = make_edge(
        RelativePose::from_covariance(from, to, composed.mean, test::full_covariance(0.1, 0.1)));
    const Eigen::Matrix3d found = drift.of(edge, parts.nodes);
    EXPECT_LT((found - composed.covariance).norm(), 1e-9 * composed.covariance.norm()) << from;
    EXPECT_NEAR(least_chi2(drift, edge, parts.nodes), 0.0, 1e-9);
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

TEST(RobustGraph, FindsTheRightLoopsAmongFalseOnes) {
  const MeasurementLog log = circle(200);
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
  const MeasurementLog log = circle(100);
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
  const MeasurementLog log = circle(60);
  const std::vector<Pose> plain = solve(log, {}).poses;
  const Solved robust = solve(log, loss("truncated"));
  EXPECT_LT(mean_distance_m(robust.poses, plain), 0.01);
  // Measurements that agree exactly are no reason to distrust any.
  const Solved exact = solve(circle(60, 0.0), loss("truncated"));
  for (const double weight : exact.weights) EXPECT_EQ(weight, 1.0);
}

TEST(RobustGraph, WeightsStandInTheOrderOfTheRegistrations) {
  MeasurementLog log = circle(40);
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

TEST(RobustGraph, RefusesWhatWouldHaveNoEffect) {
  const auto refuses = [](const EstimatorValues& values, SolveMode mode) {
    EXPECT_THROW(builtin_estimators().find("sparse_gauss_newton").create({{}, mode}, values),
                 InputError);
  };
  refuses(test::values({{"loss_scale", "2"}}), SolveMode::batch);
  refuses(test::values({{"loss", "huber"}, {"graduation", "convex"}}), SolveMode::batch);
  refuses(test::values({{"loss", "huber"}, {"start", "lago"}}), SolveMode::batch);
  EXPECT_THROW(builtin_estimators().find("ceres_pose_graph").create({}, loss("truncated")),
               InputError);
}

}  // namespace
}  // namespace fathom
