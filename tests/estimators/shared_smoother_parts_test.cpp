// The gradient and the tree of incremental_smoother with the errors that pictures share, against
// differences of F.

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/incremental_smoother/clique_tree.hpp"
#include "estimators/incremental_smoother/gradient.hpp"
#include "tests/measurements/shared_log.hpp"

namespace fathom::incremental_smoother {
namespace {

// A walk at poses and errors that are off.
struct SharedParts {
  MeasurementLog log = test::SharedWalk(14, 4, 6).log;
  Problem problem;
  Gradient gradient{problem};
  std::vector<int> variables;

  explicit SharedParts(bool folds_singles) : problem(make_node(0.0, 0.0, 0.0), {}, folds_singles) {
    RandomStream random(2, "parts");
    for (std::size_t k = 1; k < log.size(); ++k) {
      const Pose pose = log.odometry()[k];
      problem.add_node(make_node(pose.x + 0.1 * random.normal(), pose.y + 0.1 * random.normal(),
                                 pose.theta + 0.02 * random.normal()));
      gradient.add_keyframe();
      problem.add_edge(pose_graph::make_edge(log.arrival(k).step));
      gradient.add_edge();
      for (const RelativePose& z : log.arrival(k).registrations) add(z);
    }
    for (int k = 0; k < problem.size(); ++k) {
      if (k > 0) variables.push_back(k);
      if (problem.pictures.has(k)) variables.push_back(errors_of(k));
    }
    for (Node& n : problem.pictures.errors) {
      n = pose_graph::make_errors(n.x + random.normal(), n.y - 0.2, n.theta + random.normal());
    }
    gradient.evaluate_all();
  }

  void add(const RelativePose& z) {
    for (const int k : {static_cast<int>(z.from), static_cast<int>(z.to)}) {
      const int e = problem.pictures.folded_edge(k);
      if (!z.shared || e < 0) continue;
      // What is folded and at its optimum when unfolded has the same F and gradient.
      const double F = gradient.cost();
      const Vec3 of_pose = gradient.by_variable()[k];
      gradient.take_out(e);
      problem.unfold(k);
      gradient.evaluate(e);
      gradient.evaluate_prior(k);
      EXPECT_NEAR(gradient.cost(), F, 1e-9 * F);
      for (std::size_t a = 0; a < 3; ++a) {
        EXPECT_NEAR(gradient.by_variable()[k][a], of_pose[a], 1e-6 * (1.0 + std::abs(of_pose[a])));
        EXPECT_NEAR(gradient.by_variable()[errors_of(k)][a], 0.0, 1e-9);
      }
    }
    problem.add_edge(pose_graph::make_edge(z), true, 3, z.shared.get());
    gradient.add_edge();
  }

  double cost_with(int v, int a, double by) {
    const Node at_v = problem.node(v);
    double d[3] = {0.0, 0.0, 0.0};
    d[a] = by;
    problem.node(v) = is_errors(v) ? corrected_errors(at_v, d) : corrected(at_v, d);
    double F = 0.0;
    const pose_graph::ExtendedGraph graph = problem.pictures.extended(problem.edges, problem.nodes);
    F = pose_graph::cost_of(graph.edges, graph.nodes);
    problem.node(v) = at_v;
    return F;
  }

  Eigen::VectorXd stacked(const ByVariable<Vec3>& values) const {
    Eigen::VectorXd stack(static_cast<Eigen::Index>(3 * variables.size()));
    Eigen::Index row = 0;
    for (const int v : variables) {
      for (const double value : values[v]) stack[row++] = value;
    }
    return stack;
  }
};

TEST(SharedSmootherParts, GradientIsThatOfTheCost) {
  for (const bool folds : {true, false}) {
    SharedParts parts(folds);
    ASSERT_GT(parts.variables.size(), at(parts.problem.size()) + 5);
    const double step = 1e-6;
    EXPECT_NEAR(parts.gradient.cost(), parts.cost_with(1, 0, 0.0), 1e-9 * parts.gradient.cost());
    const double largest = parts.stacked(parts.gradient.by_variable()).cwiseAbs().maxCoeff();
    for (const int v : parts.variables) {
      for (int a = 0; a < 3; ++a) {
        const double slope =
            0.5 * (parts.cost_with(v, a, step) - parts.cost_with(v, a, -step)) / (2.0 * step);
        EXPECT_NEAR(parts.gradient.by_variable()[v][at(a)], slope, 1e-6 * largest) << v;
      }
    }
  }
}

// The residuals' Jacobian by differences; W and the priors at its sides.
Eigen::MatrixXd gauss_newton_matrix(SharedParts& parts) {
  const auto n = static_cast<Eigen::Index>(3 * parts.variables.size());
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
  Problem& problem = parts.problem;
  for (const Edge& edge : problem.edges) {
    const auto residual = [&] {
      const Edge left =
          edge.shared ? pose_graph::without_errors(edge, problem.pictures.errors) : edge;
      return pose_graph::residual_of(left, problem.nodes[at(edge.from)],
                                     problem.nodes[at(edge.to)]);
    };
    Eigen::MatrixXd J(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      const int v = parts.variables[static_cast<std::size_t>(i / 3)];
      const Node at_v = problem.node(v);
      double d[3] = {0.0, 0.0, 0.0};
      const auto with = [&](double by) {
        d[i % 3] = by;
        problem.node(v) = is_errors(v) ? corrected_errors(at_v, d) : corrected(at_v, d);
        const Eigen::Vector3d nu = residual();
        problem.node(v) = at_v;
        return nu;
      };
      J.col(i) = (with(1e-5) - with(-1e-5)) / 2e-5;
    }
    H += J.transpose() * pose_graph::full(edge.W) * J;
  }
  for (Eigen::Index i = 0; i < n; ++i) {
    if (is_errors(parts.variables[static_cast<std::size_t>(i / 3)])) H(i, i) += 1.0;
  }
  return H;
}

TEST(SharedSmootherParts, TreeIsTheFactorOfTheGaussNewtonMatrix) {
  for (const bool folds : {true, false}) {
    SharedParts parts(folds);
    CliqueTree tree(parts.problem, std::size_t{1} << 30U);
    ASSERT_TRUE(tree.refactor(parts.variables, parts.problem.size() - 1));
    const Eigen::MatrixXd inverse = gauss_newton_matrix(parts).inverse();
    const Eigen::VectorXd g = parts.stacked(parts.gradient.by_variable());
    const double promised = g.dot(inverse * g);
    EXPECT_NEAR(tree.forward_all(parts.gradient.by_variable()).promised(), promised,
                1e-6 * promised);
    // Again after a few of them were eliminated anew, with both kinds among them.
    const std::vector<int> some{2, errors_of(2), errors_of(5), 9};
    ASSERT_TRUE(tree.refactor(some, parts.problem.size() - 1));
    EXPECT_NEAR(tree.forward_all(parts.gradient.by_variable()).promised(), promised,
                1e-6 * promised);
    ASSERT_TRUE(tree.relinearise(some));
    for (std::size_t i = 0; i < parts.variables.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(3 * i);
      const std::vector<CliqueTree::Response> response{
          {parts.variables[i], Eigen::Matrix3d::Identity()}};
      const Eigen::Matrix3d C = inverse.block<3, 3>(row, row);
      EXPECT_LT((tree.variance(response) - C).norm(), 1e-6 * C.norm()) << parts.variables[i];
    }
  }
}

}  // namespace
}  // namespace fathom::incremental_smoother
