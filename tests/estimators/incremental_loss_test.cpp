// The robust loss of incremental_smoother: its gradient, its matrix, and weights that change as
// loops arrive.

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/incremental_smoother/incremental_smoother.hpp"
#include "estimators/incremental_smoother/smoother.hpp"
#include "fathom/measurements/spoil.hpp"
#include "tests/estimators/cross_estimator.hpp"
#include "tests/estimators/keyframe_by_keyframe.hpp"
#include "tests/estimators/smoother_logs.hpp"

namespace fathom {
namespace {

using namespace incremental_smoother;  // NOLINT: its parts are what is tested
using test::arrive;
using test::make;

const std::vector<LossKind> kKinds{LossKind::huber, LossKind::cauchy, LossKind::geman_mcclure,
                                   LossKind::dcs};

// A log at dead reckoning with noise on every pose, so that loops have residuals of all sizes.
struct Parts {
  MeasurementLog log = test::wandering_log(40, 6);
  Problem problem;
  Gradient gradient;
  std::vector<int> ranks;  // as they would be of semi-definite information

  explicit Parts(LossKind kind)
      : problem(make_node(1.0, -2.0, 3.1), RobustLoss(kind, 3.0)), gradient(problem) {
    RandomStream random(2, "parts");
    for (std::size_t k = 1; k < log.size(); ++k) {
      const Pose pose = test::perturbed(log.odometry()[k], 0.1, 0.02, random);
      problem.add_node(make_node(pose.x, pose.y, pose.theta));
      gradient.add_keyframe();
    }
    for (std::size_t k = 1; k < log.size(); ++k) {
      add(log.arrival(k).step, false);
      for (const RelativePose& z : log.arrival(k).registrations) add(z, true);
    }
  }

  void add(const RelativePose& z, bool is_loop) {
    ranks.push_back(1 + static_cast<int>(ranks.size() % 3));
    problem.add_edge(pose_graph::make_edge(z), is_loop, ranks.back());
    gradient.add_edge();
  }

  // Straight from the definition: f ρ(s / f) of the loops' s = eᵀ Ω e, f by the rank.
  double cost() const {
    const auto pose = [&](std::size_t k) { return pose_graph::pose_of(problem.nodes[k]); };
    const RobustLoss& loss = problem.loops.loss();
    double sum = 0.0;
    std::size_t e = 0;
    for (std::size_t k = 1; k < log.size(); ++k) {
      sum += chi2(log.arrival(k).step, pose(k - 1), pose(k));
      ++e;
      for (const RelativePose& z : log.arrival(k).registrations) {
        const double f = squared_scale_share(loss.kind(), ranks[e++]);
        sum += f * loss.at(chi2(z, pose(z.from), pose(z.to)) / f).rho;
      }
    }
    return sum;
  }
};

TEST(IncrementalLoss, TheGradientIsThatOfTheRobustCost) {
  for (const LossKind kind : kKinds) {
    Parts parts(kind);
    const double F = parts.cost();
    EXPECT_NEAR(parts.gradient.cost(), F, 1e-9 * F);
    double largest = 0.0;
    for (const Vec3& g : parts.gradient.by_variable().poses) {
      for (const double element : g) largest = std::max(largest, std::abs(element));
    }
    for (std::size_t k = 1; k < parts.log.size(); ++k) {
      const Node at_k = parts.problem.nodes[k];
      for (int a = 0; a < 3; ++a) {
        double F_at[2];
        for (const int side : {0, 1}) {
          double d[3] = {0.0, 0.0, 0.0};
          d[a] = side == 0 ? -1e-6 : 1e-6;
          parts.problem.nodes[k] = corrected(at_k, d);
          F_at[side] = parts.cost();
        }
        parts.problem.nodes[k] = at_k;
        const double slope = 0.5 * (F_at[1] - F_at[0]) / 2e-6;
        EXPECT_NEAR(parts.gradient.by_variable().poses[k][at(a)], slope, 1e-6 * largest) << k;
      }
    }
  }
}

// A loop counts in the tree as an edge with ρ'(s) W: dense algebra with such edges and no loss.
TEST(IncrementalLoss, TheTreeHasWhatTheLoopsWeigh) {
  for (const LossKind kind : kKinds) {
    Parts parts(kind);
    CliqueTree tree(parts.problem, std::size_t{1} << 30U);
    std::vector<int> all;
    for (int k = 1; k < parts.problem.size(); ++k) all.push_back(k);
    tree.begin_update();
    ASSERT_TRUE(tree.refactor(all, all.back()));

    std::vector<Edge> edges = parts.problem.edges;
    std::size_t weighted = 0;
    for (int e = 0; e < parts.problem.edge_count(); ++e) {
      const double weight = parts.problem.loops.present(e);
      EXPECT_FALSE(parts.problem.loops.has_left_tree(e, 1e-12));
      for (double& element : edges[at(e)].W) element *= weight;
      weighted += weight < 0.9 ? 1 : 0;
    }
    EXPECT_GT(weighted, 5U);
    const auto n = static_cast<Eigen::Index>(3 * parts.problem.size());
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
    using Block = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
    for (const Edge& edge : edges) {
      const EdgeBlocks b =
          blocks_of(edge, parts.problem.nodes[at(edge.from)], parts.problem.nodes[at(edge.to)]);
      const Block to_from = Eigen::Map<const Block>(b.to_from.data());
      H.block<3, 3>(3 * edge.from, 3 * edge.from) += Eigen::Map<const Block>(b.from_from.data());
      H.block<3, 3>(3 * edge.to, 3 * edge.to) += Eigen::Map<const Block>(b.to_to.data());
      H.block<3, 3>(3 * edge.to, 3 * edge.from) += to_from;
      H.block<3, 3>(3 * edge.from, 3 * edge.to) += to_from.transpose();
    }
    Eigen::VectorXd g(n - 3);
    for (std::size_t k = 1; k < parts.log.size(); ++k) {
      const Vec3& g_k = parts.gradient.by_variable().poses[k];
      g.segment<3>(static_cast<Eigen::Index>(3 * (k - 1))) =
          Eigen::Vector3d(g_k[0], g_k[1], g_k[2]);
    }
    const double promised = g.dot(H.bottomRightCorner(n - 3, n - 3).llt().solve(g));
    EXPECT_NEAR(tree.forward_all(parts.gradient.by_variable()).promised(), promised,
                1e-8 * promised);
  }
}

const Smoother& smoother_of(const Estimator& estimator) {
  return dynamic_cast<const IncrementalSmoother&>(
             dynamic_cast<const AnchoredEstimator&>(estimator).relative())
      .smoother();
}

// Where a loop weighs another thing than in the tree, an update does not end.
TEST(IncrementalLoss, NoUpdateLeavesAnOldWeightInTheTree) {
  const MeasurementLog log = test::wandering_log(150, 3);
  const MeasurementLog spoiled = spoil(log, log.odometry(), {.share = 0.2}, 1).log;
  for (const char* loss : {"huber", "cauchy", "geman_mcclure", "dcs"}) {
    // Keyframes alone are never a reason.
    const auto ours =
        make("incremental_smoother", log.origin(),
             test::values({{"loss", loss}, {"relinearise_m", "1e6"}, {"relinearise_rad", "1e6"}}));
    for (std::size_t k = 1; k < spoiled.size(); ++k) {
      arrive(*ours, spoiled, k);
      const LoopWeights& loops = smoother_of(*ours).loops();
      for (int e = 0; e < static_cast<int>(loops.is_loop().size()); ++e) {
        ASSERT_FALSE(loops.has_left_tree(e, SmootherLimits{}.reweight_share)) << loss << k;
      }
    }
  }
}

}  // namespace
}  // namespace fathom
