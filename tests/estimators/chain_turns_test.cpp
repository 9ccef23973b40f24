// Headings without the keyframes of chains, and small turns of poses.

#include "estimators/support/pose_graph/chain_turns.hpp"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/batch.hpp"
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

// Between given ends each step is off by its share of the variance, whichever multiple of 2π the
// ends are apart.
TEST(ChainTurns, BetweenItsEndsAChainIsOffByTheVariancesOfItsSteps) {
  const test::GraphParts parts = test::parts_of_all_lengths();
  const ChainGraph graph(parts.edges, parts.nodes);
  const ChainTurns turns(graph);
  std::vector<double> left;
  for (std::size_t i = 0; i < graph.nodes().size(); ++i) {
    const double a = static_cast<double>(i);
    left.push_back(graph.nodes()[i].theta + 0.3 * std::sin(a) + (i % 3) * 2.0 * M_PI);
  }
  const std::vector<double> all = turns.between(left);
  ASSERT_EQ(all.size(), parts.nodes.size());
  for (std::size_t i = 0; i < graph.chains().size(); ++i) {
    const ChainGraph::Chain& chain = graph.chains()[i];
    EXPECT_NEAR(wrap_angle(all[at(chain.begin)] - left[i]), 0.0, 1e-9) << i;
    double weighted = 0.0;
    for (int t = 0; t < chain.count; ++t) {
      const Edge& step = graph.step(chain, t);
      const std::size_t k = at(chain.begin + t);
      const double off = heading_information(step) * (all[k + 1] - all[k] - step.theta);
      if (t == 0) weighted = off;
      EXPECT_NEAR(off, weighted, 1e-6 * std::abs(weighted) + 1e-6) << i << " " << t;
    }
    if (chain.is_open) {
      EXPECT_NEAR(weighted, 0.0, 1e-6);
    }
  }
}

Edge turn_edge(int from, int to, double theta, double information) {
  Edge edge;
  edge.from = from;
  edge.to = to;
  edge.theta = theta;
  edge.W = {100.0, 0.0, 0.0, 100.0, 0.0, information};
  return edge;
}

// On the spot: 100 steps and 20 more, each a little too far to port, and loops to the first
// keyframe after both. By the second the steps have added up to more than π, which rounded alone is
// less the other way: no step of the 20 is off by much then, all together by more than 5 rad. The
// keyframes behind are measured by two steps back, too, and are no chains.
TEST(ChainTurns, AChainThatIsWoundOnceTooOftenIsUnwound) {
  constexpr int kFirst = 100;
  constexpr int kSecond = 120;
  constexpr int kLast = 300;
  test::GraphParts parts;
  for (int k = 0; k < kLast; ++k) {
    const double theta = k < kFirst ? 0.025 : k < kSecond ? 0.04 : 0.0;
    parts.edges.push_back(turn_edge(k, k + 1, theta, 25.0));
    if (k > kSecond) parts.edges.push_back(turn_edge(k - 1, k + 1, theta, 25.0));
  }
  parts.edges.push_back(turn_edge(0, kFirst, 0.0, 1e4));
  parts.edges.push_back(turn_edge(0, kSecond, 0.0, 1e4));
  double theta = 0.0;
  parts.nodes.push_back(Node{});
  for (int k = 0; k < kLast; ++k) {
    theta += k < kFirst ? 0.025 : k < kSecond ? 0.04 : 0.0;
    parts.nodes.push_back(make_node(0.0, 0.0, theta));
  }
  const auto cost_from = [&](Start start) {
    std::vector<Node> nodes = parts.nodes;
    const SolveResult result = solve_batch(parts.edges, nodes, start, {100, 1e-10});
    EXPECT_EQ(result.outcome, Outcome::converged);
    return result.cost;
  };
  // 2.5 rad over 100 steps and 0.8 over 20.
  const double right = 25.0 * (2.5 * 2.5 / 100.0 + 0.8 * 0.8 / 20.0);
  EXPECT_NEAR(cost_from(Start::automatic), right, 0.01 * right);
  EXPECT_GT(cost_from(Start::lago), 10.0 * right);
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
