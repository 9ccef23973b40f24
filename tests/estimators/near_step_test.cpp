// A step by conjugate gradients with the factor of another estimate, against the factorisation.

#include <cmath>

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/solver.hpp"
#include "tests/estimators/chain_logs.hpp"

namespace fathom::pose_graph {
namespace {

using test::GraphParts;

std::vector<Node> displaced_by(double by, std::vector<Node> nodes) {
  RandomStream random(7, "near");
  for (std::size_t k = 1; k < nodes.size(); ++k) {
    nodes[k] = make_node(nodes[k].x + by * random.normal(), nodes[k].y + by * random.normal(),
                         nodes[k].theta + 0.2 * by * random.normal());
  }
  return nodes;
}

double norm_of(const std::vector<Node>& a, const std::vector<Node>& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    sum += std::pow(a[k].x - b[k].x, 2) + std::pow(a[k].y - b[k].y, 2) +
           std::pow(a[k].theta - b[k].theta, 2);
  }
  return std::sqrt(sum);
}

// Every pair of keyframes is registered, so that a factorisation costs many iterations.
GraphParts all_pairs(int keyframes) {
  GraphParts parts = test::parts_of(test::circle_of(static_cast<std::size_t>(keyframes)));
  const std::vector<Node> truth = displaced_by(0.05, parts.nodes);
  RandomStream random(11, "pairs");
  parts.edges.clear();
  for (int to = 1; to < keyframes; ++to) {
    for (int from = 0; from < to; ++from) {
      Edge edge;
      edge.from = from;
      edge.to = to;
      const Eigen::Vector3d h = residual_of(edge, truth[static_cast<std::size_t>(from)],
                                            truth[static_cast<std::size_t>(to)]);
      edge.x = h.x() + 0.02 * random.normal();
      edge.y = h.y() + 0.02 * random.normal();
      edge.theta = h.z() + 0.01 * random.normal();
      edge.W = {3000.0, 400.0, -900.0, 2000.0, 700.0, 9000.0};
      parts.edges.push_back(edge);
    }
  }
  return parts;
}

template <class Equations>
void expect_step_of_the_factorisation(Equations& near, Equations& exact,
                                      const std::vector<Node>& from,
                                      const std::vector<Node>& nodes) {
  near.linearise(from, Hessian::measured);
  EXPECT_FALSE(near.solve_near(nodes, 0).has_value());
  near.linearise(from, Hessian::measured);
  ASSERT_TRUE(near.factorise());
  const std::optional<double> cost = near.solve_near(nodes, 60);
  ASSERT_TRUE(cost.has_value());
  const double F = exact.linearise(nodes, Hessian::gauss_newton);
  EXPECT_NEAR(*cost, F, 1e-12 * F);
  ASSERT_TRUE(exact.factorise());
  exact.solve_step();
  const double promised = exact.predicted_decrease();
  EXPECT_NEAR(near.predicted_decrease(), promised, 1e-4 * promised);
  std::vector<Node> stepped;
  std::vector<Node> expected;
  near.move(nodes, stepped);
  exact.move(nodes, expected);
  EXPECT_LT(norm_of(stepped, expected), 1e-2 * norm_of(expected, nodes));
}

TEST(NearStep, IsTheStepOfTheFactorisation) {
  const GraphParts parts = all_pairs(40);
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations near(symbolic, parts.edges);
  NormalEquations exact(symbolic, parts.edges);
  EXPECT_EQ(near.iterations_worth_a_factor(), 0);
  expect_step_of_the_factorisation(near, exact, parts.nodes, displaced_by(0.1, parts.nodes));
}

TEST(NearStep, IsTheStepOfTheFactorisationWithChains) {
  const GraphParts parts = test::parts_of_all_lengths();
  const ChainGraph graph(parts.edges, parts.nodes);
  ASSERT_TRUE(graph.has_chains());
  const sparse::Symbolic symbolic =
      analyse_graph(graph.edges(), static_cast<int>(graph.nodes().size()));
  NormalEquations near_left(symbolic, graph.edges());
  NormalEquations exact_left(symbolic, graph.edges());
  ChainEquations near(graph, near_left);
  ChainEquations exact(graph, exact_left);
  std::vector<Node> nodes = displaced_by(0.005, parts.nodes);
  graph.follow_open_chain(nodes);
  expect_step_of_the_factorisation(near, exact, parts.nodes, nodes);
}

TEST(NearStep, LeadsToTheSameMinimum) {
  const GraphParts parts = all_pairs(220);
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations equations(symbolic, parts.edges);
  std::vector<Node> expected = parts.nodes;
  const SolveResult without = minimise(equations, expected, {});
  ASSERT_EQ(without.outcome, Outcome::converged);

  equations.linearise(parts.nodes, Hessian::measured);
  ASSERT_TRUE(equations.factorise());
  EXPECT_GE(equations.iterations_worth_a_factor(), SolverTuning{}.least_near_iterations);
  std::vector<Node> nodes = displaced_by(0.1, parts.nodes);
  ASSERT_TRUE(equations.solve_near(nodes, equations.iterations_worth_a_factor()));
  const SolveResult with = minimise(equations, nodes, {});
  EXPECT_EQ(with.outcome, Outcome::converged);
  EXPECT_EQ(with.is_local_minimum, true);
  EXPECT_NEAR(with.cost, without.cost, 1e-10 * without.cost);
  EXPECT_LT(norm_of(nodes, expected), 1e-6);
}

// The factor is far from the matrix, so the step is factored.
TEST(NearStep, ThatDoesNotSettleIsFactored) {
  const GraphParts parts = all_pairs(220);
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations equations(symbolic, parts.edges);
  std::vector<Node> expected = parts.nodes;
  const SolveResult without = minimise(equations, expected, {});
  const std::vector<Node> far = displaced_by(20.0, parts.nodes);
  equations.linearise(far, Hessian::gauss_newton);
  ASSERT_TRUE(equations.factorise());
  std::vector<Node> nodes = parts.nodes;
  EXPECT_FALSE(equations.solve_near(nodes, equations.iterations_worth_a_factor()).has_value());
  const SolveResult with = minimise(equations, nodes, {});
  EXPECT_EQ(with.outcome, Outcome::converged);
  EXPECT_EQ(with.iterations, without.iterations);
  EXPECT_NEAR(with.cost, without.cost, 1e-10 * without.cost);
}

}  // namespace
}  // namespace fathom::pose_graph
