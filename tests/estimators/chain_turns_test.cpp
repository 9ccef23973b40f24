// Headings without the keyframes of chains, and small turns of poses.

#include "estimators/support/pose_graph/chain_turns.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/headings.hpp"
#include "tests/estimators/chain_logs.hpp"

namespace fathom::pose_graph {
namespace {

TEST(ChainTurns, AreTheHeadingsOfAllKeyframes) {
  const test::GraphParts parts = test::parts_of_all_lengths();
  const ChainGraph graph(parts.edges, parts.nodes);
  const ChainTurns turns(graph);
  const sparse::Symbolic symbolic = parts.analysed();
  const sparse::Symbolic left =
      analyse_graph(graph.edges(), static_cast<int>(graph.nodes().size()));
  std::vector<double> theta{parts.nodes[0].theta};
  for (std::size_t k = 1; k < parts.nodes.size(); ++k) {
    theta.push_back(theta.back() + wrap_angle(parts.nodes[k].theta - parts.nodes[k - 1].theta));
  }
  ASSERT_GT(theta.back(), 3.0 * M_PI);
  const std::vector<double> expected = HeadingProblem(symbolic, parts.edges).solve(theta);
  HeadingProblem left_problem(left, turns.edges());
  const std::vector<double> solved = turns.solve(left_problem, theta);
  ASSERT_EQ(solved.size(), expected.size());
  double moved = 0.0;
  for (std::size_t k = 0; k < theta.size(); ++k) {
    EXPECT_NEAR(solved[k], expected[k], 1e-12) << k;
    moved = std::max(moved, std::abs(expected[k] - theta[k]));
  }
  EXPECT_GT(moved, 1e-3);
}

// Each step is rounded along the given headings, not their sum: 39 steps that measure 0.1 rad too
// much add up to more than π.
TEST(ChainTurns, AreRoundedStepByStep) {
  test::GraphParts parts;
  for (int k = 0; k < 39; ++k) {
    Edge step;
    step.from = k;
    step.to = k + 1;
    step.x = 1.0;
    step.theta = 0.1;
    step.W = {1.0, 0.0, 0.0, 1.0, 0.0, 1.0};
    parts.edges.push_back(step);
  }
  Edge loop = parts.edges[0];
  loop.to = 39;
  loop.x = 39.0;
  loop.theta = 0.0;
  loop.W = {1e4, 0.0, 0.0, 1e4, 0.0, 1e4};
  parts.edges.push_back(loop);
  parts.nodes.assign(40, Node{});
  const ChainGraph graph(parts.edges, parts.nodes);
  ASSERT_TRUE(graph.has_chains());
  const ChainTurns turns(graph);
  const sparse::Symbolic symbolic = parts.analysed();
  const sparse::Symbolic left =
      analyse_graph(graph.edges(), static_cast<int>(graph.nodes().size()));
  const std::vector<double> theta(40, 0.0);
  const std::vector<double> expected = HeadingProblem(symbolic, parts.edges).solve(theta);
  HeadingProblem left_problem(left, turns.edges());
  const std::vector<double> solved = turns.solve(left_problem, theta);
  for (std::size_t k = 0; k < theta.size(); ++k) EXPECT_NEAR(solved[k], expected[k], 1e-10) << k;
  EXPECT_NEAR(solved[39], 0.0, 1e-3);
}

TEST(ChainTurns, MovedPosesKeepTheirCosine) {
  for (const double turn : {0.0, 1e-12, -3e-5, 0.004, -0.02, 0.029999, 0.03, -1.0, 7.0}) {
    for (const double theta : {0.0, 1.0, -3.1, 12.0}) {
      const Node node = moved(make_node(1.0, -2.0, theta), 0.5, 0.25, turn);
      EXPECT_EQ(node.x, 1.5);
      EXPECT_EQ(node.theta, theta + turn);
      // Of that, theta + turn is rounded.
      const double ulps = 3e-16 + 1.2e-16 * std::abs(node.theta);
      EXPECT_NEAR(node.c, std::cos(node.theta), ulps) << theta << " " << turn;
      EXPECT_NEAR(node.s, std::sin(node.theta), ulps) << theta << " " << turn;
    }
  }
}

}  // namespace
}  // namespace fathom::pose_graph
