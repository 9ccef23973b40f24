// Groups of loops: which belong together, and what the rest of a graph says of them as a whole.

#include "estimators/sparse_gauss_newton/loop_groups.hpp"

#include <gtest/gtest.h>

#include "estimators/sparse_gauss_newton/leave_one_out.hpp"
#include "estimators/sparse_gauss_newton/lost_groups.hpp"
#include "tests/estimators/graph_parts.hpp"

namespace fathom {
namespace {

using namespace sparse_gauss_newton;  // NOLINT: its parts are what is tested
using test::circle_of;
using test::GraphParts;
using test::parts_of;

// Every second loop written the other way round.
MeasurementLog alternately_turned(const MeasurementLog& log) {
  MeasurementLog mixed(log.origin());
  bool turn = false;
  for (std::size_t k = 1; k < log.size(); ++k) {
    mixed.add_keyframe(log.arrival(k).step);
    for (const RelativePose& z : log.arrival(k).registrations) {
      mixed.add_registration(turn ? z.reversed() : z);
      turn = !turn;
    }
  }
  return mixed;
}

TEST(LoopGroups, AreTheSameWhateverWayRoundALoopIsWritten) {
  const MeasurementLog log = circle_of(60);
  const auto any = [](const Edge&, const Edge&) { return true; };
  const auto groups = [&](const GraphParts& parts) {
    return group_loops(parts.edges, parts.loops(), 5, any);
  };
  const auto straight = groups(parts_of(log));
  EXPECT_LT(straight.size(), parts_of(log).loops().size() / 2);
  EXPECT_EQ(groups(parts_of(alternately_turned(log))), straight);
}

TEST(LoopGroups, LostOnesAreFoundWhateverWayRoundALoopIsWritten) {
  const MeasurementLog log = circle_of(60, 0.1);
  const auto lost = [](const MeasurementLog& graph) {
    const GraphParts parts = parts_of(graph);
    sparse_gauss_newton::Consensus none;
    none.weights.assign(parts.edges.size(), 1.0);
    for (const std::size_t e : parts.loops()) none.weights[e] = 0.0;
    none.squared_scales = {20.0, 20.0};
    return lost_groups({parts.edges, parts.is_loop}, none, parts.nodes, {});
  };
  const auto straight = lost(log);
  ASSERT_FALSE(straight.empty());
  EXPECT_EQ(lost(alternately_turned(log)), straight);
}

TEST(GroupChi2, OfOneLoopIsLeaveOneOut) {
  const GraphParts parts = parts_of(circle_of(30, 0.1));
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations equations(symbolic, parts.edges);
  const std::vector<double> all(parts.edges.size(), 1.0);
  std::vector<Node> nodes = parts.nodes;
  minimise(equations, nodes, {50, 1e-14});
  const std::vector<double> chi2 =
      leave_one_out(equations, {parts.edges, parts.is_loop}, all, nodes);
  for (std::size_t e = 0; e < parts.edges.size(); ++e) {
    if (parts.is_loop[e] == 0) continue;
    EXPECT_NEAR(group_chi2(equations, {e}, all, nodes), chi2[e], 1e-6 * (1.0 + chi2[e]));
  }
}

// Three loops, all of them off by 3 m.
MeasurementLog agreeing_false_loops() {
  MeasurementLog log;
  const Eigen::Matrix3d step = Eigen::Vector3d(0.01, 0.01, 0.0004).asDiagonal();
  const Eigen::Matrix3d loop = Eigen::Vector3d(1e-4, 1e-4, 1e-5).asDiagonal();
  for (std::size_t k = 1; k <= 12; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.0, 0.0, 0.0}, step));
    if (k >= 10) log.add_registration(RelativePose::from_covariance(k - 9, k, {6, 0, 0}, loop));
  }
  return log;
}

// A group that agrees within itself: none of its loops contradicts the rest, all together do.
void expect_contradicted_as_a_group(const MeasurementLog& log) {
  GraphParts parts = parts_of(log);
  const sparse::Symbolic symbolic = parts.analysed();
  NormalEquations equations(symbolic, parts.edges);
  const std::vector<double> all(parts.edges.size(), 1.0);
  minimise(equations, parts.nodes, {50, 1e-12});
  const std::vector<double> chi2 =
      leave_one_out(equations, {parts.edges, parts.is_loop}, all, parts.nodes);
  std::vector<std::size_t> group;
  for (std::size_t e = 0; e < parts.edges.size(); ++e) {
    if (parts.is_loop[e] != 0) group.push_back(e);
  }
  for (const std::size_t e : group) EXPECT_LT(chi2[e], 16.0);
  // About 3² / (7 · 0.01): the steps that all three span, and a part of the others.
  EXPECT_GT(group_chi2(equations, group, all, parts.nodes), 80.0);
}

TEST(GroupChi2, SeesWhatLeavingOneOutDoesNot) {
  expect_contradicted_as_a_group(agreeing_false_loops());
}

TEST(GroupChi2, SeesItWhateverWayRoundALoopIsWritten) {
  expect_contradicted_as_a_group(alternately_turned(agreeing_false_loops()));
}

}  // namespace
}  // namespace fathom
