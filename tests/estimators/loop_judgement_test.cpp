// What the rest of a graph says of one loop, and what dead reckoning could have drifted.

#include <cmath>

#include <gtest/gtest.h>

#include "estimators/sparse_gauss_newton/drift.hpp"
#include "estimators/sparse_gauss_newton/leave_one_out.hpp"
#include "fathom/geometry/covariance.hpp"
#include "tests/estimators/graph_parts.hpp"

namespace fathom {
namespace {

using namespace sparse_gauss_newton;  // NOLINT: its parts are what is tested
using test::circle_of;
using test::GraphParts;
using test::parts_of;

// Gradient and Hessian of Σ ρ against differences of it, weights included.
TEST(RobustDerivatives, AreThoseOfTheCost) {
  const GraphParts parts = parts_of(circle_of(12, 10.0));
  const sparse::Symbolic symbolic = parts.analysed();
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

// By how much F falls without a loop, its own part aside, by solving again without it. With little
// noise, as the test is linear.
TEST(LeaveOneOut, IsWhatALoopCosts) {
  const GraphParts parts = parts_of(circle_of(30, 0.1));
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations equations(symbolic, parts.edges);
  const auto least = [&](const std::vector<double>& weights, std::vector<Node>& nodes) {
    equations.set_loss({RobustLoss(), {}, weights});
    return minimise(equations, nodes, {50, 1e-14}).cost;
  };
  const std::vector<double> all(parts.edges.size(), 1.0);
  std::vector<Node> nodes = parts.nodes;
  const double with_all = least(all, nodes);
  const std::vector<double> chi2 =
      leave_one_out(equations, {parts.edges, parts.is_loop}, all, nodes);
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
    EXPECT_NEAR(leave_one_out(equations, {parts.edges, parts.is_loop}, weights, without)[e], rise,
                0.02 * rise);
    weights[e] = 0.4;
    least(weights, without);
    EXPECT_NEAR(leave_one_out(equations, {parts.edges, parts.is_loop}, weights, without)[e], rise,
                0.02 * rise);
    ++checked;
  }
  EXPECT_GT(checked, 5u);
}

// Against the steps composed one by one.
TEST(Drift, IsThatOfTheStepsComposed) {
  const MeasurementLog log = circle_of(40);
  const GraphParts parts = parts_of(log);
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
    EXPECT_NEAR(least_chi2(drift, edge, 3, parts.nodes), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace fathom
