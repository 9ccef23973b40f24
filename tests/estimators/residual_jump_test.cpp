// A loop whose heading residual is ±π at the estimate: F jumps there.

#include <numbers>

#include <gtest/gtest.h>

#include "estimators/support/pose_graph/solver.hpp"
#include "tests/estimators/graph_parts.hpp"

namespace fathom::pose_graph {
namespace {

// A step that turns by −0.01, and a loop turned by π whose error in x correlates with that in
// heading.
MeasurementLog turned_loop(double loop_x) {
  MeasurementLog log(Pose{});
  const Eigen::Vector3d sigma{0.01, 0.01, 0.01};
  log.add_keyframe(RelativePose::from_covariance(0, 1, {1.0, 0.0, -0.01},
                                                 sigma.cwiseAbs2().asDiagonal().toDenseMatrix()));
  Eigen::Matrix3d C = Eigen::Matrix3d::Identity();
  C(0, 2) = C(2, 0) = -0.7;
  log.add_registration(RelativePose::from_covariance(0, 1, {loop_x, 0.0, std::numbers::pi}, C));
  return log;
}

struct Ended {
  SolveResult result;
  double heading = 0.0;
};

Ended ended_from(double heading, double loop_x) {
  test::GraphParts parts = test::parts_of(turned_loop(loop_x));
  parts.nodes = nodes_of(std::vector<Pose>{{}, {1.0, 0.0, heading}});
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations equations(symbolic, parts.edges);
  const SolveResult result = minimise(equations, parts.nodes, {200, 1e-8});
  return {result, std::atan2(parts.nodes[1].s, parts.nodes[1].c)};
}

TEST(ResidualJump, TheLeastFBesideItIsNoNumericalFailure) {
  // Above 0 the correlation makes F lower than below it, where dead reckoning is.
  const Ended beside = ended_from(0.005, -1.0);
  EXPECT_EQ(beside.result.outcome, Outcome::iteration_limit);
  EXPECT_FALSE(beside.result.is_local_minimum.has_value());
  EXPECT_GE(beside.heading, 0.0);
  EXPECT_LT(beside.heading, 1e-6);
  // The other way round F falls over the jump, and the minimum is none of it.
  const Ended beyond = ended_from(0.005, 3.0);
  EXPECT_EQ(beyond.result.outcome, Outcome::converged);
  EXPECT_NEAR(beyond.heading, -0.01, 1e-3);
}

}  // namespace
}  // namespace fathom::pose_graph
