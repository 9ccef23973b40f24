// Graphs whose unknowns are poses and the errors that pictures share.

#include <array>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/support/pose_graph/normal_equations.hpp"
#include "estimators/support/pose_graph/picture_states.hpp"
#include "fathom/measurements/g2o.hpp"
#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/graph_parts.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/measurements/shared_log.hpp"

namespace fathom {
namespace {

using pose_graph::EdgeLoss;
using pose_graph::ExtendedGraph;
using pose_graph::Hessian;
using pose_graph::Node;
using pose_graph::NormalEquations;
using pose_graph::PictureStates;
using test::SharedWalk;

ExtendedGraph extended(const MeasurementLog& log, bool folds_singles) {
  static test::GraphParts parts;
  parts = test::parts_of(log);
  PictureStates states(folds_singles);
  std::size_t edge = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    ++edge;
    for (const RelativePose& z : log.arrival(k).registrations) {
      if (z.shared) states.add(z, edge);
      ++edge;
    }
  }
  return states.extended(parts.edges, parts.nodes);
}

std::vector<Node> moved(std::vector<Node> nodes, std::size_t i, double by) {
  Node& node = nodes[i / 3 + 1];
  std::array<double, 3> v{node.x, node.y, node.theta};
  v[i % 3] += by;
  node = is_pose(node) ? pose_graph::make_node(v[0], v[1], v[2])
                       : pose_graph::make_errors(v[0], v[1], v[2]);
  return nodes;
}

std::vector<double> by_node(const sparse::Symbolic& symbolic, const std::vector<double>& v) {
  std::vector<double> result(v.size());
  for (std::size_t i = 0; i < v.size(); ++i) {
    result[i] = v[3 * static_cast<std::size_t>(symbolic.position[i / 3]) + i % 3];
  }
  return result;
}

// At errors that are not zero, with a loss on the loops and without.
void expect_derivatives(const EdgeLoss& loss) {
  const SharedWalk walk(12, 4, 5);
  const ExtendedGraph graph = extended(walk.log, true);
  std::vector<Node> nodes = graph.nodes;
  for (std::size_t k = pose_graph::keyframes_of(nodes); k < nodes.size(); ++k) {
    nodes[k] = pose_graph::make_errors(0.3, -0.2 * static_cast<double>(k % 5), 0.1);
  }
  ASSERT_GT(nodes.size(), pose_graph::keyframes_of(nodes) + 5);
  const auto symbolic = pose_graph::analyse_graph(graph.edges, static_cast<int>(nodes.size()));
  NormalEquations equations(symbolic, graph.edges);
  equations.set_loss(loss);
  const double F = equations.linearise(nodes, Hessian::exact);
  EXPECT_DOUBLE_EQ(equations.differentiate(nodes), F);
  if (loss.is_robust.empty()) {
    EXPECT_NEAR(F, pose_graph::cost_of(graph.edges, nodes), 1e-9 * F);
  }
  const std::vector<double> gradient = by_node(symbolic, equations.gradient());
  const auto n = static_cast<Eigen::Index>(gradient.size());
  const double norm = Eigen::Map<const Eigen::VectorXd>(gradient.data(), n).norm();
  Eigen::MatrixXd hessian(n, n);
  const double step = 1e-6;
  for (Eigen::Index i = 0; i < n; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const double up = equations.linearise(moved(nodes, at, step), Hessian::exact);
    const std::vector<double> g_up = by_node(symbolic, equations.gradient());
    const double down = equations.differentiate(moved(nodes, at, -step));
    const std::vector<double> g_down = by_node(symbolic, equations.gradient());
    EXPECT_NEAR(gradient[at], 0.5 * (up - down) / (2 * step), 1e-5 * norm);
    for (Eigen::Index j = 0; j < n; ++j) {
      const auto row = static_cast<std::size_t>(j);
      hessian(j, i) = (g_up[row] - g_down[row]) / (2 * step);
    }
  }
  const Eigen::VectorXd newton =
      -hessian.partialPivLu().solve(Eigen::Map<const Eigen::VectorXd>(gradient.data(), n));
  equations.linearise(nodes, Hessian::exact);
  ASSERT_TRUE(equations.factorise());
  const std::vector<double> found = by_node(symbolic, equations.solve_step());
  EXPECT_LT((Eigen::Map<const Eigen::VectorXd>(found.data(), n) - newton).norm(),
            1e-5 * newton.norm());
}

TEST(SharedGraph, DerivativesAreThoseOfTheCost) {
  expect_derivatives({});
}

TEST(SharedGraph, DerivativesAreThoseOfTheCostWithALoss) {
  const test::GraphParts parts = test::parts_of(SharedWalk(12, 4, 5).log);
  const LossOptions cauchy{LossKind::cauchy, 2.0};
  expect_derivatives({RobustLoss(cauchy), parts.is_loop});
}

struct Way {
  std::string estimator;
  SolveMode mode = SolveMode::incremental;
  EstimatorValues values;
};

// A gate that lets all pass leaves no registration to its picture alone.
std::vector<Way> ways() {
  EstimatorValues gated = test::exactly();
  gated["gate_probability"] = OptionValue::scalar("0.999999999");
  return {{"sparse_gauss_newton", SolveMode::incremental, test::exactly()},
          {"sparse_gauss_newton", SolveMode::batch, test::exactly()},
          {"sparse_gauss_newton", SolveMode::incremental, gated},
          {"ceres_pose_graph", SolveMode::incremental, test::exactly()},
          {"ceres_pose_graph", SolveMode::batch, test::exactly()}};
}

std::unique_ptr<Estimator> solved(const Way& way, const MeasurementLog& log) {
  auto estimator = test::make(way.estimator, log.start(), way.values, way.mode);
  for (std::size_t k = 1; k < log.size(); ++k) test::arrive(*estimator, log, k);
  EXPECT_EQ(estimator->finish().outcome, Outcome::converged);
  return estimator;
}

TEST(SharedGraph, EqualsLeastSquaresWithTheJointCovariance) {
  for (const int per_keyframe : {1, 4}) {
    const MeasurementLog log = SharedWalk(30, per_keyframe, 11).log;
    const auto expected = conformance::least_squares(log, 30, {}, RegistrationErrors::shared);
    const std::vector<std::size_t> some{29, 4, 0, 17, 4};
    for (const Way& way : ways()) {
      SCOPED_TRACE(way.estimator + (way.mode == SolveMode::batch ? " batch " : " ") +
                   std::to_string(per_keyframe));
      const auto estimator = solved(way, log);
      EXPECT_TRUE(estimator->estimates_shared_errors());
      for (std::size_t k = 0; k < log.size(); ++k) {
        const Pose off = between(expected.poses[k], estimator->pose(k));
        EXPECT_LT(off.vector().norm(), 1e-9) << k;
        const Eigen::Matrix3d marginal = expected.marginal(k);
        EXPECT_LT((*estimator->covariance(k) - marginal).norm(), 1e-7 * marginal.norm() + 1e-15);
      }
      EXPECT_LT(conformance::largest_block_difference(*estimator->joint_covariance(some),
                                                      expected.joint(some)),
                1e-7);
      const auto motions = estimator->motions_to_newest();
      ASSERT_TRUE(motions);
      for (std::size_t k = 0; k < motions->size(); ++k) {
        const Eigen::Matrix3d motion = expected.motion_to_newest(k).covariance;
        EXPECT_LT(((*motions)[k].covariance - motion).norm(), 1e-7 * motion.norm());
      }
    }
  }
}

// A false loop among those that share errors has no part in the estimate, or little.
TEST(SharedGraph, LossesLeaveAFalseLoopOut) {
  const SharedWalk walk(30, 4, 11);
  MeasurementLog spoilt(walk.log.start());
  for (std::size_t k = 1; k < walk.log.size(); ++k) {
    spoilt.add_keyframe(walk.log.arrival(k).step);
    for (RelativePose z : walk.log.arrival(k).registrations) spoilt.add_registration(z);
    if (k != 20) continue;
    RelativePose false_loop = walk.log.arrival(k).registrations.back();
    ASSERT_TRUE(false_loop.shared);
    false_loop.motion.x += 2.0;
    spoilt.add_registration(false_loop);
  }
  const auto right = conformance::least_squares(walk.log, 30, {}, RegistrationErrors::shared);
  const auto wrong = conformance::least_squares(spoilt, 30, {}, RegistrationErrors::shared);
  const auto off = [&](const auto& pose) {
    double most = 0.0;
    for (std::size_t k = 0; k < walk.log.size(); ++k) {
      most = std::max(most, between(right.poses[k], pose(k)).position().norm());
    }
    return most;
  };
  ASSERT_GT(off([&](std::size_t k) { return wrong.poses[k]; }), 0.05);
  for (const SolveMode mode : {SolveMode::incremental, SolveMode::batch}) {
    for (const char* loss : {"truncated", "geman_mcclure", "cauchy"}) {
      const auto estimator =
          solved({"sparse_gauss_newton", mode, test::exactly_with(loss)}, spoilt);
      EXPECT_LT(off([&](std::size_t k) { return estimator->pose(k); }), 0.02) << loss;
    }
  }
}

TEST(SharedGraph, IndependentIsWhatAGraphIsThatIsToldNothing) {
  const MeasurementLog log = SharedWalk(30, 4, 11).log;
  const MeasurementLog untold = parse_g2o(to_g2o(log), "graph.g2o");
  Way way{"sparse_gauss_newton", SolveMode::incremental, {}};
  way.values["shared_errors"] = OptionValue::scalar("independent");
  const auto estimator = solved(way, log);
  EXPECT_FALSE(estimator->estimates_shared_errors());
  const auto expected = solved({way.estimator, way.mode, {}}, untold);
  for (std::size_t k = 0; k < log.size(); ++k) {
    EXPECT_EQ(estimator->pose(k), expected->pose(k));
    EXPECT_EQ(*estimator->covariance(k), *expected->covariance(k));
  }
}

double least_chi2(const MeasurementLog& log) {
  return shared_chi2(log,
                     conformance::least_squares(log, 30, {}, RegistrationErrors::shared).poses);
}

// All measurements before keyframe k and its step.
MeasurementLog before(const MeasurementLog& log, std::size_t k) {
  MeasurementLog part(log.start());
  for (std::size_t j = 1; j <= k; ++j) {
    part.add_keyframe(log.arrival(j).step);
    if (j == k) break;
    for (const RelativePose& z : log.arrival(j).registrations) part.add_registration(z);
  }
  return part;
}

// Of each new loop the NIS is what F, minimised over poses and errors, rises by for it alone; to
// first order, and so with little noise.
TEST(SharedGraph, GatesTestWhatIsLeftOfTheSharedErrors) {
  const MeasurementLog log = SharedWalk(16, 4, 3).log;
  EstimatorValues values = test::exactly();
  values["gate_probability"] = OptionValue::scalar("0.999999999");
  auto estimator = test::make("sparse_gauss_newton", log.start(), values);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const UpdateReport report = test::arrive(*estimator, log, k);
    for (std::size_t j = 0; j < report.loops.size(); ++j) {
      MeasurementLog with = before(log, k);
      const double F = least_chi2(with);
      with.add_registration(log.arrival(k).registrations[j]);
      const double rise = least_chi2(with) - F;
      EXPECT_NEAR(*report.loops[j].nis, rise, 0.08 * rise + 1e-2) << k;
    }
  }
}

}  // namespace
}  // namespace fathom
