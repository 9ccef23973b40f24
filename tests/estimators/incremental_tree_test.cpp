// The tree of incremental_smoother, against dense algebra: the factor that grows, and the step down
// the tree.

#include <algorithm>
#include <numeric>
#include <set>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/incremental_smoother/clique_tree.hpp"
#include "fathom/core/random.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom::incremental_smoother {
namespace {

using pose_graph::make_edge;

Eigen::Vector3d vector_of(const Vec3& v) {
  return {v[0], v[1], v[2]};
}

Eigen::Matrix3d matrix_of(const std::array<double, 9>& m) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(m.data());
}

Node moved(const Node& node, const Eigen::Vector3d& d) {
  return corrected(node, d.data());
}

// Grown as an estimator grows it: some keyframes, then loops, again and again.
struct Grown {
  Problem problem{make_node(1.0, 2.0, 3.0)};
  CliqueTree tree;
  RandomStream random{3, "grown"};

  explicit Grown(std::size_t most_kept_bytes = std::size_t{1} << 30U)
      : tree(problem, most_kept_bytes) {}

  void add_keyframes(int count) {
    for (int j = 0; j < count; ++j) {
      const Node& last = problem.nodes.back();
      problem.add_node(make_node(last.x + random.normal(), last.y + random.normal(),
                                 last.theta + random.normal()));
      add_edge(problem.size() - 2, problem.size() - 1);
    }
  }

  void add_edge(int from, int to) {
    problem.add_edge(make_edge(RelativePose::from_covariance(
        static_cast<std::size_t>(from), static_cast<std::size_t>(to),
        {random.normal(), random.normal(), random.normal()}, test::full_covariance(0.3, 0.2))));
  }

  bool update(int keyframes, int loops) {
    std::vector<int> touched;
    for (int k = problem.size() - 1; k < problem.size() + keyframes; ++k) {
      if (k > 0) touched.push_back(k);
    }
    add_keyframes(keyframes);
    const int newest = problem.size() - 1;
    for (int j = 0; j < loops; ++j) {
      const int other = std::min(newest - 1, static_cast<int>(random.uniform(0.0, newest)));
      add_edge(j % 2 == 0 ? other : newest, j % 2 == 0 ? newest : other);
      if (other > 0) touched.push_back(other);
    }
    tree.begin_update();
    return tree.refactor(touched, newest);
  }

  Eigen::MatrixXd dense() const {
    const auto n = static_cast<Eigen::Index>(3 * problem.size());
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(n, n);
    for (const Edge& edge : problem.edges) {
      const EdgeBlocks b =
          blocks_of(edge, problem.nodes[at(edge.from)], problem.nodes[at(edge.to)]);
      H.block<3, 3>(3 * edge.from, 3 * edge.from) += matrix_of(b.from_from);
      H.block<3, 3>(3 * edge.to, 3 * edge.to) += matrix_of(b.to_to);
      H.block<3, 3>(3 * edge.to, 3 * edge.from) += matrix_of(b.to_from);
      H.block<3, 3>(3 * edge.from, 3 * edge.to) += matrix_of(b.to_from).transpose();
    }
    return H.bottomRightCorner(n - 3, n - 3);
  }

  // A gradient that is not that of the edges, and so small that a step is linear in it.
  std::vector<Vec3> small_gradient() {
    std::vector<Vec3> gradient(at(problem.size()));
    for (Vec3& g : gradient) {
      for (double& element : g) element = 1e-7 * random.normal();
    }
    return gradient;
  }

  static Eigen::VectorXd stacked(const std::vector<Vec3>& gradient) {
    Eigen::VectorXd g(static_cast<Eigen::Index>(3 * (gradient.size() - 1)));
    for (std::size_t k = 1; k < gradient.size(); ++k) {
      g.segment<3>(static_cast<Eigen::Index>(3 * (k - 1))) = vector_of(gradient[k]);
    }
    return g;
  }
};

void expect_factor(Grown& grown) {
  const Eigen::MatrixXd inverse = grown.dense().inverse();
  const std::vector<Vec3> gradient = grown.small_gradient();
  const Eigen::VectorXd g = Grown::stacked(gradient);
  const double promised = g.dot(inverse * g);
  const CliqueTree::Step solved = grown.tree.forward_all({gradient});
  EXPECT_NEAR(solved.promised(), promised, 1e-8 * promised);
  const std::vector<Node> before = grown.problem.nodes;
  grown.tree.propagate(solved, 0.0);
  grown.tree.settle();
  const Eigen::VectorXd step = -inverse * g;
  double worst = 0.0;
  for (int k = 1; k < grown.problem.size(); ++k) {
    double d[3];
    offset_of(before[at(k)], grown.problem.nodes[at(k)], d);
    for (int a = 0; a < 3; ++a) worst = std::max(worst, std::abs(d[a] - step(3 * (k - 1) + a)));
  }
  EXPECT_LT(worst, 1e-5 * step.cwiseAbs().maxCoeff());
  grown.problem.nodes = before;
}

TEST(IncrementalTree, IsTheFactorOfTheWholeMatrixHoweverItGrew) {
  Grown grown;
  for (const int keyframes : {6, 1, 4, 12, 1, 1, 30, 2}) {
    ASSERT_TRUE(grown.update(keyframes, 3));
    expect_factor(grown);
  }
}

TEST(IncrementalTree, IsTheFactorWhateverItHadToDrop) {
  Grown keeps;
  Grown drops(0);
  int kept = 0;
  int dropped = 0;
  for (int j = 0; j < 60; ++j) {
    const int keyframes = j % 7 == 0 ? 12 : 3;
    ASSERT_TRUE(keeps.update(keyframes, 1));
    ASSERT_TRUE(drops.update(keyframes, 1));
    kept += keeps.tree.refactored();
    dropped += drops.tree.refactored();
    if (j % 5 != 0) continue;
    expect_factor(drops);
    keeps.small_gradient();  // the same random numbers
  }
  EXPECT_GT(dropped, kept);
}

TEST(IncrementalTree, SolvesForAFewKeyframesAndGivesVariances) {
  Grown grown;
  for (const int keyframes : {20, 7, 9}) ASSERT_TRUE(grown.update(keyframes, 4));
  const Eigen::MatrixXd inverse = grown.dense().inverse();
  std::vector<Vec3> gradient(at(grown.problem.size()));
  const std::vector<Vec3> ignored = gradient;
  gradient[5] = {1e-7, -2e-7, 3e-7};
  gradient[30] = {2e-7, 2e-7, -1e-7};
  const Eigen::VectorXd g = Grown::stacked(gradient);
  const double promised = g.dot(inverse * g);
  const std::vector<int> keyframes{5, 30};
  EXPECT_NEAR(grown.tree.forward(keyframes, {gradient}, {ignored}).promised(), promised,
              1e-8 * promised);
  // What is ignored is left out of b.
  EXPECT_NEAR(grown.tree.forward(keyframes, {gradient}, {gradient}).promised(), 0.0, 1e-30);

  const Eigen::Matrix3d J_i = Eigen::Matrix3d::Random();
  const Eigen::Matrix3d J_k = Eigen::Matrix3d::Random();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, inverse.cols());
  J.middleCols<3>(3 * (11 - 1)) = J_i;
  J.middleCols<3>(3 * (36 - 1)) = J_k;
  const Eigen::Matrix3d both = J * inverse * J.transpose();
  EXPECT_LT((grown.tree.variance({{11, J_i}, {36, J_k}}) - both).norm(), 1e-8 * both.norm());
  J.middleCols<3>(3 * (11 - 1)).setZero();
  const Eigen::Matrix3d fixed = J * inverse * J.transpose();
  EXPECT_LT((grown.tree.variance({{0, J_i}, {36, J_k}}) - fixed).norm(), 1e-8 * fixed.norm());
}

TEST(IncrementalTree, IsLinearisedAnewWhereItIsStale) {
  Grown grown;
  for (const int keyframes : {20, 7, 9}) ASSERT_TRUE(grown.update(keyframes, 4));
  const Eigen::MatrixXd old = grown.dense();
  for (int k = 1; k < grown.problem.size(); ++k) {
    const Eigen::Vector3d d{0.3 * grown.random.normal(), 0.3, 0.2 * grown.random.normal()};
    grown.problem.nodes[at(k)] = moved(grown.problem.nodes[at(k)], d);
  }
  const std::vector<Vec3> gradient = grown.small_gradient();
  const Eigen::VectorXd g = Grown::stacked(gradient);
  const double stale = g.dot(old.llt().solve(g));
  const double fresh = g.dot(grown.dense().llt().solve(g));
  ASSERT_GT(std::abs(stale - fresh), 0.01 * fresh);
  const CliqueTree::Step step = grown.tree.forward_all({gradient});
  EXPECT_NEAR(step.promised(), stale, 1e-8 * stale);
  grown.tree.propagate(step, 0.0);
  grown.tree.settle();
  std::vector<int> keyframes;
  grown.tree.find_to_relinearise(1e-3, 1e-3, keyframes);
  ASSERT_TRUE(grown.tree.relinearise(keyframes));
  EXPECT_NEAR(grown.tree.forward_all({gradient}).promised(), fresh, 1e-5 * fresh);
}

TEST(IncrementalTree, RigidMotionOfAPartMovesAllOfIt) {
  Grown grown;
  grown.add_keyframes(40);
  std::vector<int> all(40);
  std::iota(all.begin(), all.end(), 1);
  ASSERT_TRUE(grown.tree.refactor(all, 40));
  // A force at one keyframe of a chain bends it as far as there, and carries the rest along: to
  // second order in the bend.
  std::vector<Vec3> gradient(41);
  const std::vector<Vec3> ignored = gradient;
  gradient[10] = {3e-3, -2e-3, 5e-3};
  const std::vector<int> keyframes{10};
  const std::vector<Node> before = grown.problem.nodes;
  grown.tree.propagate(grown.tree.forward(keyframes, {gradient}, {ignored}), 1e-9);
  grown.tree.settle();
  for (int k = 11; k <= 40; ++k) {
    double was[3];
    double now[3];
    offset_of(before[10], before[at(k)], was);
    offset_of(grown.problem.nodes[10], grown.problem.nodes[at(k)], now);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(now[a], was[a], 3e-5) << k;
  }
  double moved_by[3];
  offset_of(before[40], grown.problem.nodes[40], moved_by);
  EXPECT_GT(std::hypot(moved_by[0], moved_by[1]), 3e-4);
  EXPECT_LT(grown.tree.bent().size(), 30U);
  for (int k = 1; k <= 40; ++k) {
    offset_of(before[at(k)], grown.problem.nodes[at(k)], moved_by);
    EXPECT_GT(std::hypot(moved_by[0], moved_by[1]), 0.0) << k;
  }
}

TEST(IncrementalTree, SaysWhatIsNotDefinite) {
  Grown grown;
  ASSERT_TRUE(grown.update(5, 1));
  Edge bad = grown.problem.edges.front();
  bad.from = 2;
  bad.to = 5;
  for (double& element : bad.W) element *= -1e3;
  grown.problem.add_edge(bad);
  const std::vector<int> keyframes{2, 5};
  EXPECT_FALSE(grown.tree.refactor(keyframes, 5));
  grown.problem.forget_edges(grown.problem.edge_count() - 1);
  const std::vector<int> all{1, 2, 3, 4, 5};
  EXPECT_TRUE(grown.tree.refactor(all, 5));
}

}  // namespace
}  // namespace fathom::incremental_smoother
