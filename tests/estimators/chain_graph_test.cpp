// A graph without the keyframes of its chains, against the whole one.

#include <numbers>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/support/pose_graph/batch.hpp"
#include "estimators/support/pose_graph/chains.hpp"
#include "tests/estimators/chain_logs.hpp"

namespace fathom::pose_graph {
namespace {

using test::circled_twice;
using test::dense;
using test::Derivatives;
using test::GraphParts;
using test::kLoops;

TEST(ChainGraph, HasTheKeyframesThatMoreThanTwoStepsMeasure) {
  const GraphParts parts = test::parts_of(circled_twice(100, kLoops, 1.0));
  ChainGraph chains(parts.edges, parts.nodes);
  ASSERT_TRUE(chains.measure());
  // 0, both ends of five loops, of which two share one; what follows 80 is left out.
  ASSERT_EQ(chains.nodes().size(), 9u);
  EXPECT_EQ(chains.edges().size(), 8u + 5u);
  EXPECT_EQ(chains.nodes()[1].x, parts.nodes[12].x);
  EXPECT_EQ(chains.nodes()[8].theta, parts.nodes[80].theta);
  // The step from 12 to 13 is one as it was.
  EXPECT_EQ(chains.edges()[1].W, parts.edges[12].W);
}

// At dead reckoning the steps have no residuals, and the elimination of a chain is exact there.
TEST(ChainGraph, AChainIsWhatIsLeftOfItsStepsWhereTheRestIsEliminated) {
  const GraphParts parts = test::parts_of(circled_twice(9, {{0, 8}}, 1.0));
  ChainGraph chains(parts.edges, parts.nodes);
  ASSERT_TRUE(chains.measure());
  ASSERT_EQ(chains.edges().size(), 2u);
  std::vector<Edge> steps(parts.edges.begin(), parts.edges.end() - 1);
  const Eigen::MatrixXd H = dense(steps, parts.nodes).H;
  const Eigen::Index inner = H.rows() - 3;
  const Eigen::Matrix3d left =
      H.bottomRightCorner<3, 3>() -
      H.bottomLeftCorner(3, inner) *
          H.topLeftCorner(inner, inner).ldlt().solve(H.topRightCorner(inner, 3));
  const Eigen::MatrixXd composed = dense(std::span(chains.edges()).first(1), chains.nodes()).H;
  EXPECT_LT((composed - left).norm(), 1e-9 * left.norm());
  EXPECT_LT(residual_of(chains.edges()[0], chains.nodes()[0], chains.nodes()[1]).norm(), 1e-12);
}

TEST(ChainGraph, ExpandedChainsAreAtTheirMinimumBetweenTheirEnds) {
  const GraphParts parts = test::parts_of(circled_twice(100, kLoops, 1.0));
  ChainGraph chains(parts.edges, parts.nodes);
  ASSERT_TRUE(chains.measure());
  std::vector<Node> moved = chains.nodes();
  for (std::size_t k = 1; k < moved.size(); ++k) {
    const auto a = static_cast<double>(k);
    moved[k] = make_node(moved[k].x + 0.1 * std::sin(a), moved[k].y - 0.1 * std::cos(3.0 * a),
                         moved[k].theta + 0.02 * std::sin(5.0 * a) + 2.0 * std::numbers::pi);
  }
  const std::vector<Node> all = chains.expanded(moved);
  ASSERT_EQ(all.size(), 100u);
  EXPECT_EQ(all[12].x, moved[1].x);
  const Derivatives d = dense(parts.edges, all);
  const Derivatives before = dense(parts.edges, parts.nodes);
  for (const int k : {1, 5, 11, 20, 29, 40, 49, 55, 70, 79, 81, 90, 99}) {
    const Eigen::Vector3d g = d.g.segment<3>(3 * (k - 1));
    const Eigen::Vector3d scale = d.H.diagonal().segment<3>(3 * (k - 1)).cwiseSqrt();
    EXPECT_LT(g.cwiseQuotient(scale).norm(), 1e-3) << k;
  }
  EXPECT_GT(d.g.segment<3>(3 * 11).norm(), 1.0);  // a loop's end has been moved
}

double cost_from_truth(const GraphParts& parts, const SolveLimits& limits) {
  std::vector<Node> nodes = parts.nodes;
  const SolveResult result = solve_batch(parts.edges, nodes, Start::lifted, limits);
  EXPECT_EQ(result.outcome, Outcome::converged);
  return result.cost;
}

TEST(ChainGraph, TheMinimumIsThatOfTheWholeGraph) {
  for (const double share : {0.0, 1.0, 3.0}) {
    const GraphParts parts = test::parts_of(circled_twice(100, kLoops, share));
    ASSERT_TRUE(ChainGraph(parts.edges, parts.nodes).measure());
    std::vector<Node> nodes = parts.nodes;
    const SolveResult result = solve_batch(parts.edges, nodes, Start::automatic, {100, 1e-10});
    EXPECT_EQ(result.outcome, Outcome::converged);
    EXPECT_EQ(result.is_local_minimum, true);
    EXPECT_LE(result.iterations, 3);
    EXPECT_NEAR(result.cost, cost_from_truth(parts, {100, 1e-10}), 1e-8 * (1.0 + result.cost));
  }
}

TEST(ChainGraph, AChainWithoutLoopsIsItsDeadReckoning) {
  const GraphParts parts = test::parts_of(circled_twice(40, {}, 1.0));
  ChainGraph chains(parts.edges, parts.nodes);
  ASSERT_TRUE(chains.measure());
  EXPECT_EQ(chains.nodes().size(), 1u);
  const std::vector<Node> all = chains.expanded(chains.nodes());
  EXPECT_LT(cost_of(parts.edges, all), 1e-20);
}

TEST(ChainGraph, OfOtherGraphsThereIsNone) {
  const MeasurementLog log = circled_twice(100, kLoops, 1.0);
  const auto is_worthwhile = [](const GraphParts& parts) {
    return ChainGraph(parts.edges, parts.nodes).measure();
  };
  GraphParts parts = test::parts_of(log);
  parts.edges.erase(parts.edges.begin() + 20);
  EXPECT_FALSE(is_worthwhile(parts)) << "a hole";

  parts = test::parts_of(log);
  parts.edges[20].W[2] = parts.edges[20].W[4] = parts.edges[20].W[5] = 0.0;
  EXPECT_FALSE(is_worthwhile(parts)) << "a step without heading";

  parts = test::parts_of(log);
  const SharedEnds shared;
  parts.edges.back().shared = &shared;
  EXPECT_FALSE(is_worthwhile(parts)) << "errors of pictures";

  parts = test::parts_of(log);
  for (int k = 2; k < 100; k += 2) {
    Edge loop = parts.edges[at(k)];
    loop.from = 0;
    loop.to = k;
    parts.edges.push_back(loop);
  }
  EXPECT_FALSE(is_worthwhile(parts)) << "loops of every second keyframe";

  parts.nodes.resize(1);
  EXPECT_FALSE(ChainGraph({}, parts.nodes).measure()) << "one keyframe";
}

}  // namespace
}  // namespace fathom::pose_graph
