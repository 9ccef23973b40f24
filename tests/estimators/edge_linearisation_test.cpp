// The linearisations of an edge that the estimators have, each against differences of one residual
// that is written through homogeneous matrices: identity, headings about ±π, tiny and random
// motions, full information.

#include <array>
#include <cmath>
#include <functional>
#include <ostream>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/ceres_pose_graph/edge_cost.hpp"
#include "estimators/incremental_smoother/local_edge.hpp"
#include "estimators/support/pose_graph/edge.hpp"
#include "estimators/trajectory_iekf/stretch.hpp"
#include "support/planar.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

struct EdgeCase {
  Pose A;
  Pose B;
  RelativePose z;
};

/// F of an edge, ½ ∂F/∂(A, B) and the Gauss-Newton matrix of ½F: additive perturbations.
struct Linearised {
  double cost = 0.0;
  Vector6 gradient;
  Matrix6 hessian;
};

Linearised from_jacobian(const Eigen::Vector3d& residual, const Eigen::Matrix<double, 3, 6>& J,
                         const Eigen::Matrix3d& information) {
  return {residual.dot(information * residual), J.transpose() * information * residual,
          J.transpose() * information * J};
}

Eigen::Vector3d textbook_residual(const Pose& z, const Pose& A, const Pose& B) {
  return test::t2v(test::homogeneous(z).inverse() * test::homogeneous(A).inverse() *
                   test::homogeneous(B));
}

Linearised by_differences(const EdgeCase& edge) {
  const Pose& z = edge.z.motion;
  Eigen::Matrix<double, 3, 6> J;
  J << test::numerical_jacobian([&](const Pose& A) { return textbook_residual(z, A, edge.B); },
                                edge.A),
      test::numerical_jacobian([&](const Pose& B) { return textbook_residual(z, edge.A, B); },
                               edge.B);
  return from_jacobian(textbook_residual(z, edge.A, edge.B), J, edge.z.information);
}

// ceres_pose_graph: whitened, so that the information is the identity.
Linearised by_edge_cost(const EdgeCase& edge) {
  using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  const Eigen::Vector3d A = edge.A.vector();
  const Eigen::Vector3d B = edge.B.vector();
  const std::array<const double*, 2> parameters{A.data(), B.data()};
  Eigen::Vector3d r;
  RowMajor J_A;
  RowMajor J_B;
  std::array<double*, 2> jacobians{J_A.data(), J_B.data()};
  EXPECT_TRUE(EdgeCost(edge.z).Evaluate(parameters.data(), r.data(), jacobians.data()));
  Eigen::Matrix<double, 3, 6> J;
  J << J_A, J_B;
  return from_jacobian(r, J, Eigen::Matrix3d::Identity());
}

// sparse_gauss_newton: M, m and the lever.
Linearised by_edge_terms(const EdgeCase& edge) {
  const std::array<Pose, 2> ends{edge.A, edge.B};
  const std::vector<pose_graph::Node> nodes = pose_graph::nodes_of(ends);
  const pose_graph::EdgeTerms t =
      pose_graph::linearise_edge(pose_graph::make_edge(edge.z), nodes[0], nodes[1]);
  Eigen::Matrix3d T = Eigen::Matrix3d::Identity();
  T(0, 2) = -t.dy;
  T(1, 2) = t.dx;
  const Eigen::Matrix3d M = pose_graph::full(t.M);
  const Eigen::Vector3d m(t.m[0], t.m[1], t.m[2]);
  Linearised result;
  result.cost = t.cost;
  result.gradient << -T.transpose() * m, m;
  result.hessian << T.transpose() * M * T, -T.transpose() * M, -M * T, M;
  return result;
}

// incremental_smoother: corrections along each keyframe's own axes.
Linearised by_local_edge(const EdgeCase& edge) {
  const std::array<Pose, 2> ends{edge.A, edge.B};
  const std::vector<pose_graph::Node> nodes = pose_graph::nodes_of(ends);
  const pose_graph::Edge z = pose_graph::make_edge(edge.z);
  const auto g = incremental_smoother::gradient_of(z, nodes[0], nodes[1]);
  const auto blocks = incremental_smoother::blocks_of(z, nodes[0], nodes[1]);
  const auto matrix = [](const std::array<double, 9>& rows) {
    return Eigen::Matrix3d(
        Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data()));
  };
  // From world axes to those of the keyframe.
  Matrix6 turn = Matrix6::Identity();
  turn.block<2, 2>(0, 0) = rotation(edge.A.theta).transpose();
  turn.block<2, 2>(3, 3) = rotation(edge.B.theta).transpose();
  Vector6 gradient;
  gradient << g.from[0], g.from[1], g.from[2], g.to[0], g.to[1], g.to[2];
  Matrix6 hessian;
  hessian << matrix(blocks.from_from), matrix(blocks.to_from).transpose(), matrix(blocks.to_from),
      matrix(blocks.to_to);
  return {g.cost, turn.transpose() * gradient, turn.transpose() * hessian * turn};
}

// ekf: ν = z − h(x) and its covariance R.
Linearised by_innovation(const EdgeCase& edge) {
  Eigen::Matrix3d H_A;
  Eigen::Matrix3d H_B;
  const Pose h = between(edge.A, edge.B, &H_A, &H_B);
  Eigen::Vector3d nu = edge.z.motion.vector() - h.vector();
  nu.z() = wrap_angle(nu.z());
  Eigen::Matrix<double, 3, 6> J;
  J << -H_A, -H_B;
  return from_jacobian(nu, J, edge.z.covariance().inverse());
}

// trajectory_iekf: H with respect to two motions that lead from A to B by way of a third place.
Linearised by_stretch(const EdgeCase& edge) {
  const Pose middle{1.5, -0.5, 2.0};
  Eigen::Matrix3d first_A;
  Eigen::Matrix3d second_B;
  const std::array<Pose, 2> motions{between(edge.A, middle, &first_A, nullptr),
                                    between(middle, edge.B, nullptr, &second_B)};
  const Stretch stretch(0, motions);
  const Eigen::Matrix3Xd H = stretch.H(0);
  Eigen::Vector3d nu = edge.z.motion.vector() - stretch.h(0).vector();
  nu.z() = wrap_angle(nu.z());
  Eigen::Matrix<double, 3, 6> J;
  J << -H.leftCols<3>() * first_A, -H.rightCols<3>() * second_B;
  return from_jacobian(nu, J, edge.z.covariance().inverse());
}

std::vector<EdgeCase> edge_cases() {
  RandomStream random(7, "edges");
  const auto measured = [&](const Pose& z) {
    return RelativePose::from_covariance(0, 1, z, test::random_covariance(random, 0.01));
  };
  const auto tiny = [&] {
    return Pose{random.uniform(-1e-8, 1e-8), random.uniform(-1e-8, 1e-8),
                random.uniform(-1e-8, 1e-8)};
  };
  std::vector<EdgeCase> cases{{{}, {}, measured({})}};
  for (int i = 0; i < 10; ++i) {
    cases.push_back({tiny(), tiny(), measured(tiny())});
    cases.push_back({test::random_pose(random), test::random_pose(random),
                     measured(test::random_pose(random))});
  }
  // Headings, turns and measurements on either side of ±π; the residual itself is not on the cut.
  for (const double a : {M_PI - 1e-9, -M_PI + 1e-9, 0.3}) {
    for (const double b : {M_PI, -M_PI + 1e-8, a + M_PI - 1e-9}) {
      const double turn = wrap_angle(b - a);
      for (const double off : {1e-8, -0.2}) {
        cases.push_back({{3.0, -2.0, a},
                         {-1.0, 4.0, wrap_angle(b)},
                         measured({2.0, 1.0, wrap_angle(turn + off)})});
      }
    }
  }
  return cases;
}

struct Linearisation {
  std::string name;
  std::function<Linearised(const EdgeCase&)> of;
};

void PrintTo(const Linearisation& linearisation, std::ostream* out) {
  *out << linearisation.name;
}

class EdgeLinearisation : public testing::TestWithParam<Linearisation> {};

INSTANTIATE_TEST_SUITE_P(Every, EdgeLinearisation,
                         testing::Values(Linearisation{"ceres_pose_graph", by_edge_cost},
                                         Linearisation{"sparse_gauss_newton", by_edge_terms},
                                         Linearisation{"incremental_smoother", by_local_edge},
                                         Linearisation{"ekf", by_innovation},
                                         Linearisation{"trajectory_iekf", by_stretch}),
                         [](const auto& linearisation) { return linearisation.param.name; });

TEST_P(EdgeLinearisation, IsThatOfTheTextbookResidual) {
  for (const EdgeCase& edge : edge_cases()) {
    const Linearised expected = by_differences(edge);
    const Linearised found = GetParam().of(edge);
    SCOPED_TRACE(testing::Message()
                 << "A " << edge.A.vector().transpose() << ", B " << edge.B.vector().transpose()
                 << ", z " << edge.z.motion.vector().transpose());
    const double scale = expected.hessian.norm();
    const double size = std::sqrt(scale * expected.cost);
    EXPECT_NEAR(found.cost, expected.cost, 1e-9 * expected.cost + 1e-14 * size + 1e-28 * scale);
    EXPECT_LT((found.hessian - expected.hessian).norm(), 1e-7 * scale);
    // W ν: what differences leave of J counts little where the residual is tiny.
    EXPECT_LT((found.gradient - expected.gradient).norm(), 1e-7 * size + 1e-14 * scale);
  }
}

}  // namespace
}  // namespace fathom
