// The derivatives that sparse_gauss_newton takes its steps by, against differences of the cost.

#include <array>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/support/pose_graph/solver.hpp"
#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/graph_parts.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

using namespace pose_graph;  // NOLINT: its parts are what is tested
using test::LogOptions;

// In the order of keyframes 1 ….
Eigen::VectorXd by_keyframe(const sparse::Symbolic& symbolic, const std::vector<double>& v) {
  Eigen::VectorXd result(static_cast<Eigen::Index>(v.size()));
  for (int node = 0; node < symbolic.size(); ++node) {
    const int p = symbolic.position[static_cast<std::size_t>(node)];
    for (int a = 0; a < 3; ++a) result(3 * node + a) = v[static_cast<std::size_t>(3 * p + a)];
  }
  return result;
}

// Noise large enough that second derivatives of the residuals count.
TEST(SparseGaussNewtonDerivatives, AreThoseOfTheCost) {
  LogOptions options;
  options.keyframes = 12;
  options.noise = 10.0;
  const MeasurementLog log = test::circle_log(options);
  const std::vector<Edge> edges = test::parts_of(log).edges;
  const std::vector<Node> nodes = nodes_of(log.odometry());
  const sparse::Symbolic symbolic = analyse_graph(edges, static_cast<int>(nodes.size()));
  NormalEquations equations(symbolic, edges);
  const auto at = [&](Eigen::Index i, double by) {
    std::vector<Node> moved = nodes;
    Node& node = moved[static_cast<std::size_t>(i / 3 + 1)];
    std::array<double, 3> v{node.x, node.y, node.theta};
    v[static_cast<std::size_t>(i % 3)] += by;
    node = make_node(v[0], v[1], v[2]);
    return moved;
  };
  const double F = equations.linearise(nodes, Hessian::exact);
  EXPECT_NEAR(F, chi2(log, log.odometry()), 1e-9 * F);
  const Eigen::VectorXd gradient = by_keyframe(symbolic, equations.gradient());
  const Eigen::Index n = gradient.size();
  const double step = 1e-6;
  Eigen::MatrixXd hessian(n, n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const double up = equations.linearise(at(i, step), Hessian::exact);
    const Eigen::VectorXd g_up = by_keyframe(symbolic, equations.gradient());
    const double down = equations.linearise(at(i, -step), Hessian::exact);
    const Eigen::VectorXd g_down = by_keyframe(symbolic, equations.gradient());
    EXPECT_NEAR(gradient(i), 0.5 * (up - down) / (2 * step), 1e-5 * gradient.norm());
    hessian.col(i) = (g_up - g_down) / (2 * step);
  }
  // H⁻¹ g of the exact Hessian, and of Gauss-Newton's, which differs from it.
  const auto step_of = [&](Hessian kind) {
    equations.linearise(nodes, kind);
    EXPECT_TRUE(equations.factorise());
    return by_keyframe(symbolic, equations.solve_step());
  };
  const Eigen::VectorXd newton = -hessian.partialPivLu().solve(gradient);
  EXPECT_LT((step_of(Hessian::exact) - newton).norm(), 1e-5 * newton.norm());
  EXPECT_GT((step_of(Hessian::gauss_newton) - newton).norm(), 1e-2 * newton.norm());
  const std::vector<Pose> textbook = test::least_squares(log, 1).poses;
  const Eigen::VectorXd gauss_newton = step_of(Hessian::gauss_newton);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const auto i = static_cast<Eigen::Index>(3 * (k - 1));
    EXPECT_NEAR(nodes[k].x + gauss_newton(i), textbook[k].x, 1e-8);
    EXPECT_NEAR(nodes[k].y + gauss_newton(i + 1), textbook[k].y, 1e-8);
  }
}

// The gradient alone is that of the whole, and leaves the factor of before where it was.
TEST(SparseGaussNewtonDerivatives, GradientAloneLeavesTheFactor) {
  const MeasurementLog log = test::circle_of(60);
  const test::GraphParts parts = test::parts_of(log);
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations whole(symbolic, parts.edges);
  NormalEquations apart(symbolic, parts.edges);
  whole.linearise(parts.nodes, Hessian::exact);
  ASSERT_TRUE(whole.factorise());
  whole.solve_step();
  std::vector<Node> moved;
  whole.move(parts.nodes, moved);
  const double F = apart.linearise(moved, Hessian::exact);
  EXPECT_EQ(whole.differentiate(moved), F);
  EXPECT_EQ(whole.gradient(), apart.gradient());
  const std::vector<double> chord = whole.solve_step();
  whole.linearise(parts.nodes, Hessian::exact);
  ASSERT_TRUE(whole.factorise());
  std::vector<double> expected = apart.gradient();
  for (double& g : expected) g = -g;
  whole.solve(expected.data());
  EXPECT_EQ(chord, expected);
}

// With chords and without: the same minimum, of which both say that it is one.
TEST(SparseGaussNewtonDerivatives, ChordsEndWhereNewtonDoes) {
  for (const double noise : {0.3, 1.0, 3.0, 10.0}) {
    const test::GraphParts parts = test::parts_of(test::circle_of(300, noise));
    const sparse::Symbolic symbolic = parts.analysed();
    NormalEquations equations(symbolic, parts.edges);
    SolverTuning without;
    without.chord_below = 0.0;
    std::vector<Node> with_chords = parts.nodes;
    std::vector<Node> by_newton = parts.nodes;
    const SolveResult chords = minimise(equations, with_chords, {50, 1e-8});
    const SolveResult newton = minimise(equations, by_newton, {50, 1e-14}, without);
    EXPECT_EQ(chords.outcome, Outcome::converged);
    EXPECT_EQ(chords.is_local_minimum, newton.is_local_minimum);
    EXPECT_NEAR(chords.cost, newton.cost, 1e-8 * newton.cost) << noise;
    for (std::size_t k = 0; k < by_newton.size(); ++k) {
      EXPECT_NEAR(with_chords[k].x, by_newton[k].x, 1e-4) << noise << " at " << k;
      EXPECT_NEAR(with_chords[k].theta, by_newton[k].theta, 1e-4) << noise << " at " << k;
    }
  }
}

}  // namespace
}  // namespace fathom
