// The elimination of chains, against the equations of all keyframes.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/batch.hpp"
#include "estimators/support/pose_graph/positions.hpp"
#include "tests/estimators/chain_logs.hpp"

namespace fathom::pose_graph {
namespace {

using test::GraphParts;
using test::parts_of_all_lengths;

struct BothWays {
  explicit BothWays(const GraphParts& parts)
      : graph(parts.edges, parts.nodes),
        left_symbolic(analyse_graph(graph.edges(), static_cast<int>(graph.nodes().size()))),
        left(left_symbolic, graph.edges()),
        chains(graph, left),
        symbolic(parts.analysed()),
        whole(symbolic, parts.edges) {}

  ChainGraph graph;
  sparse::Symbolic left_symbolic;
  NormalEquations left;
  ChainEquations chains;
  sparse::Symbolic symbolic;
  NormalEquations whole;
};

// From the minimum. Keyframes behind the last loop are where their steps lead.
std::vector<Node> displaced(const GraphParts& parts, const ChainGraph& graph, double by) {
  RandomStream random(5, "displaced");
  std::vector<Node> nodes = parts.nodes;
  EXPECT_EQ(solve_batch(parts.edges, nodes, Start::automatic, {}).outcome, Outcome::converged);
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    nodes[k] = make_node(nodes[k].x + by * random.normal(), nodes[k].y + by * random.normal(),
                         nodes[k].theta + 0.2 * by * random.normal());
  }
  graph.follow_open_chain(nodes);
  return nodes;
}

double largest_difference(const std::vector<Node>& a, const std::vector<Node>& b) {
  double largest = a.size() == b.size() ? 0.0 : HUGE_VAL;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    for (const double d : {a[k].x - b[k].x, a[k].y - b[k].y, a[k].theta - b[k].theta,
                           a[k].c - b[k].c, a[k].s - b[k].s}) {
      largest = std::max(largest, std::abs(d));
    }
  }
  return largest;
}

TEST(ChainEquations, TakeTheStepsOfAllKeyframes) {
  const GraphParts parts = parts_of_all_lengths();
  BothWays both(parts);
  ASSERT_TRUE(both.graph.has_chains());
  ASSERT_EQ(both.graph.chains().back().is_open, true);
  const std::vector<Node> nodes = displaced(parts, both.graph, 0.005);
  for (const Hessian hessian : {Hessian::gauss_newton, Hessian::measured, Hessian::exact}) {
    const double F = both.whole.linearise(nodes, hessian);
    EXPECT_NEAR(both.chains.linearise(nodes, hessian), F, 1e-12 * F);
    ASSERT_TRUE(both.whole.factorise(sparse::Inertia::positive));
    ASSERT_TRUE(both.chains.factorise(sparse::Inertia::positive));
    both.whole.solve_step();
    both.chains.solve_step();
    const double promised = both.whole.predicted_decrease();
    EXPECT_NEAR(both.chains.predicted_decrease(), promised, 1e-9 * promised);
    std::vector<Node> stepped;
    std::vector<Node> expected;
    both.chains.move(nodes, stepped);
    both.whole.move(nodes, expected);
    both.graph.follow_open_chain(expected);
    EXPECT_GT(largest_difference(expected, nodes), 0.01);
    EXPECT_LT(largest_difference(stepped, expected), 1e-8) << static_cast<int>(hessian);
    for (const double tolerance : {1e-12, 1e-5, 1e-3, 1.0}) {
      EXPECT_EQ(both.chains.step_is_small(nodes, tolerance),
                both.whole.step_is_small(nodes, tolerance));
    }

    // A chord: the gradient at the end of the step, with the factor as it is.
    const double F_there = both.whole.differentiate(expected);
    EXPECT_NEAR(both.chains.differentiate(expected), F_there, 1e-12 * F_there);
    const double norm = both.whole.gradient_norm();
    EXPECT_NEAR(both.chains.gradient_norm(), norm, 1e-9 * norm);
    both.whole.solve_step();
    both.chains.solve_step();
    const double left = both.whole.predicted_decrease();
    EXPECT_NEAR(both.chains.predicted_decrease(), left, 1e-8 * left);
    both.chains.move(expected, stepped);
    both.whole.move(expected, expected);
    both.graph.follow_open_chain(expected);
    EXPECT_LT(largest_difference(stepped, expected), 1e-8) << static_cast<int>(hessian);
  }
}

// By the rows of all edges, dense: no block of it is of the sparse solver.
TEST(ChainEquations, TakeTheTextbookStep) {
  const GraphParts parts = parts_of_all_lengths();
  BothWays both(parts);
  const std::vector<Node> nodes = displaced(parts, both.graph, 0.005);
  const test::Derivatives d = test::dense(parts.edges, nodes);
  const Eigen::VectorXd step = -d.H.ldlt().solve(d.g);
  both.chains.linearise(nodes, Hessian::gauss_newton);
  ASSERT_TRUE(both.chains.factorise());
  both.chains.solve_step();
  std::vector<Node> stepped;
  both.chains.move(nodes, stepped);
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(3 * (k - 1));
    EXPECT_NEAR(stepped[k].theta, nodes[k].theta + step(i + 2), 1e-8) << k;
    // An open chain follows its begin along the arc, a step along its tangent.
    if (k > 80) continue;
    EXPECT_NEAR(stepped[k].x, nodes[k].x + step(i), 1e-8) << k;
    EXPECT_NEAR(stepped[k].y, nodes[k].y + step(i + 1), 1e-8) << k;
  }
  both.chains.differentiate(nodes);
  EXPECT_NEAR(both.chains.gradient_norm(), 2.0 * d.g.lpNorm<Eigen::Infinity>(), 1e-9 * d.g.norm());
}

// Where one keyframe inside of a chain is displaced, or all of them smoothly: the gradient is that
// before the elimination.
TEST(ChainEquations, KnowTheGradientInsideOfAChain) {
  const GraphParts parts = parts_of_all_lengths();
  BothWays both(parts);
  const std::vector<Node> minimum = displaced(parts, both.graph, 0.0);
  both.whole.linearise(minimum, Hessian::gauss_newton);
  both.chains.linearise(minimum, Hessian::gauss_newton);
  const auto expect_same_at = [&](const std::vector<Node>& nodes) {
    both.whole.differentiate(nodes);
    both.chains.differentiate(nodes);
    const double norm = both.whole.gradient_norm();
    EXPECT_NEAR(both.chains.gradient_norm(), norm, 1e-9 * norm);
  };
  for (const std::size_t k : {5U, 17U, 18U, 24U, 60U, 64U, 65U}) {
    std::vector<Node> nodes = minimum;
    nodes[k].y += 0.1;
    expect_same_at(nodes);
  }
  std::vector<Node> nodes = minimum;
  for (std::size_t k = 48; k < 80; ++k) {
    nodes[k].x += 0.1 * std::sin(M_PI * (static_cast<double>(k) - 47.0) / 33.0);
  }
  expect_same_at(nodes);
}

// Sylvester: the negative pivots of both eliminations are the negative eigenvalues of one matrix.
TEST(ChainEquations, CountNegativeEigenvalues) {
  const GraphParts parts = parts_of_all_lengths();
  BothWays both(parts);
  int indefinite = 0;
  for (const double by : {0.005, 0.3, 1.0, 3.0}) {
    const std::vector<Node> nodes = displaced(parts, both.graph, by);
    both.whole.linearise(nodes, Hessian::exact);
    both.chains.linearise(nodes, Hessian::exact);
    ASSERT_TRUE(both.whole.factorise());
    ASSERT_TRUE(both.chains.factorise());
    const int negative = both.whole.negative_pivots();
    EXPECT_EQ(both.chains.negative_pivots(), negative) << by;
    both.chains.linearise(nodes, Hessian::exact);
    EXPECT_EQ(both.chains.factorise(sparse::Inertia::positive), negative == 0);
    indefinite += negative > 0 ? 1 : 0;
  }
  EXPECT_GE(indefinite, 2);
}

TEST(ChainEquations, HaveNoFactorWhereAPivotIsNone) {
  GraphParts parts = parts_of_all_lengths();
  for (const double of_none : {0.0, std::nan("")}) {
    parts.edges[60].W.fill(of_none);
    parts.edges[61].W.fill(of_none);
    BothWays both(parts);
    ASSERT_TRUE(both.graph.has_chains());
    both.chains.linearise(parts.nodes, Hessian::gauss_newton);
    EXPECT_FALSE(both.chains.factorise());
  }
}

// Without an open chain, which resists damping where it is among the unknowns.
TEST(ChainEquations, AreDampedAndFollowHeadings) {
  const GraphParts parts = parts_of_all_lengths({30, 99});
  BothWays both(parts);
  std::vector<Node> nodes = displaced(parts, both.graph, 0.005);
  std::vector<Node> expected;
  std::vector<Node> stepped;
  for (const double damping : {1e-3, 1.0, 1e4}) {
    both.whole.linearise(nodes, Hessian::gauss_newton, damping);
    both.chains.linearise(nodes, Hessian::gauss_newton, damping);
    ASSERT_TRUE(both.whole.factorise());
    ASSERT_TRUE(both.chains.factorise());
    both.whole.solve_step();
    both.chains.solve_step();
    both.chains.move(nodes, stepped);
    both.whole.move(nodes, expected);
    EXPECT_LT(largest_difference(stepped, expected), 1e-9) << damping;
  }
  expected = nodes;
  PositionProblem positions(both.whole.factor(), parts.edges, {});
  ASSERT_TRUE(positions.solve(expected));
  ASSERT_TRUE(both.chains.follow_headings(nodes));
  EXPECT_LT(largest_difference(nodes, expected), 1e-9);
}

// From dead reckoning that is off by far, where steps fail.
TEST(ChainEquations, EndWhereTheWholeDo) {
  for (const double share : {1.0, 10.0, 20.0, 40.0}) {
    const GraphParts parts = test::parts_of(test::circled_twice(100, test::kLoops, share));
    BothWays both(parts);
    std::vector<Node> nodes = parts.nodes;
    std::vector<Node> expected = parts.nodes;
    const SolveLimits limits{200, 1e-12};
    const SolveResult result = minimise(both.chains, nodes, limits, Hessian::gauss_newton);
    const SolveResult whole = minimise(both.whole, expected, limits);
    ASSERT_EQ(whole.outcome, Outcome::converged);
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_NEAR(result.cost, whole.cost, 1e-9 * whole.cost) << share;
    EXPECT_EQ(result.is_local_minimum, whole.is_local_minimum);
  }
}

TEST(ChainEquations, OfAGraphWithoutLoopsAreSolvedAtOnce) {
  const GraphParts parts = test::parts_of(test::circled_twice(40, {}, 1.0));
  std::vector<Node> nodes = parts.nodes;
  for (std::size_t k = 1; k < nodes.size(); ++k) nodes[k] = make_node(1.0, 2.0, 3.0);
  for (const Start start : {Start::automatic, Start::given, Start::lago, Start::chordal}) {
    const SolveResult result = solve_batch(parts.edges, nodes, start, {});
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.is_local_minimum, true);
    EXPECT_LT(result.cost, 1e-20);
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      EXPECT_NEAR(nodes[k].x, parts.nodes[k].x, 1e-12);
      EXPECT_NEAR(nodes[k].s, parts.nodes[k].s, 1e-12);
    }
  }
}

}  // namespace
}  // namespace fathom::pose_graph
