// The parts of incremental_smoother, against dense algebra: derivatives, orders, patterns, the
// factor that grows, and the step down the tree.

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

TEST(IncrementalDerivatives, AreThoseOfTheCost) {
  const Edge edge = make_edge(
      RelativePose::from_covariance(0, 1, {1.0, 0.4, 3.0}, test::full_covariance(0.3, 0.2)));
  const Node i = make_node(3.0, -2.0, 2.9);
  const Node k = make_node(2.2, -2.6, -0.5);
  const EdgeGradient at_ik = gradient_of(edge, i, k);
  const double step = 1e-6;
  // Columns of the Jacobian of ν, from differences of W ν = ∂(½F)/∂ν, which is what `to` holds once
  // it is turned back.
  const auto whitened = [&](const Node& a, const Node& b) {
    Eigen::Matrix3d Q = Eigen::Matrix3d::Identity();
    Q.topLeftCorner<2, 2>() = rotation(b.theta - a.theta);
    return (Q * vector_of(gradient_of(edge, a, b).to)).eval();
  };
  Eigen::Matrix3d WJ_i;
  Eigen::Matrix3d WJ_k;
  for (int a = 0; a < 3; ++a) {
    const Eigen::Vector3d d = step * Eigen::Vector3d::Unit(a);
    const double up_i = gradient_of(edge, moved(i, d), k).cost;
    const double down_i = gradient_of(edge, moved(i, -d), k).cost;
    EXPECT_NEAR(at_ik.from[static_cast<std::size_t>(a)], 0.25 * (up_i - down_i) / step, 1e-4);
    const double up_k = gradient_of(edge, i, moved(k, d)).cost;
    const double down_k = gradient_of(edge, i, moved(k, -d)).cost;
    EXPECT_NEAR(at_ik.to[static_cast<std::size_t>(a)], 0.25 * (up_k - down_k) / step, 1e-4);
    WJ_i.col(a) = (whitened(moved(i, d), k) - whitened(moved(i, -d), k)) / (2 * step);
    WJ_k.col(a) = (whitened(i, moved(k, d)) - whitened(i, moved(k, -d))) / (2 * step);
  }
  Eigen::Matrix3d W;
  W << edge.W[0], edge.W[1], edge.W[2], edge.W[1], edge.W[3], edge.W[4], edge.W[2], edge.W[4],
      edge.W[5];
  const Eigen::Matrix3d J_i = W.inverse() * WJ_i;
  const Eigen::Matrix3d J_k = W.inverse() * WJ_k;
  const EdgeBlocks blocks = blocks_of(edge, i, k);
  const double scale = W.norm();
  EXPECT_LT((matrix_of(blocks.from_from) - J_i.transpose() * W * J_i).norm(), 1e-6 * scale);
  EXPECT_LT((matrix_of(blocks.to_from) - J_k.transpose() * W * J_i).norm(), 1e-6 * scale);
  EXPECT_LT((matrix_of(blocks.to_to) - J_k.transpose() * W * J_k).norm(), 1e-6 * scale);
}

// A trajectory 0 … n − 2, keyframe 0 being the fixed node n − 1, with loops and a group.
RestGraph random_graph(int n, int loops, RandomStream& random) {
  RestGraph graph;
  graph.size = n;
  graph.links.push_back({n - 1, 0});
  for (int k = 1; k + 1 < n; ++k) graph.links.push_back({k - 1, k});
  const auto any = [&] { return std::min(n - 1, static_cast<int>(random.uniform(0.0, n))); };
  for (int j = 0; j < loops; ++j) {
    const int a = any();
    const int b = any();
    if (a != b) graph.links.push_back({a, b});
  }
  std::set<int> group;
  while (group.size() < 4) group.insert(any());
  graph.group_nodes.assign(group.begin(), group.end());
  graph.group_start.push_back(static_cast<int>(graph.group_nodes.size()));
  return graph;
}

// Rows below each column of the factor, by elimination of sets.
std::vector<std::set<int>> naive_fill(const RestGraph& graph, const std::vector<int>& position) {
  std::vector<std::set<int>> rows(static_cast<std::size_t>(graph.size));
  const auto link = [&](int a, int b) {
    const auto [first, second] = std::minmax(position[at(a)], position[at(b)]);
    if (first != second) rows[at(first)].insert(second);
  };
  for (const auto& l : graph.links) link(l.a, l.b);
  for (const int a : graph.group_nodes) {
    for (const int b : graph.group_nodes) link(a, b);
  }
  for (auto& column : rows) {
    if (column.empty()) continue;
    const int parent = *column.begin();
    for (const int row : column) {
      if (row != parent) rows[at(parent)].insert(row);
    }
  }
  return rows;
}

std::size_t count(const std::vector<std::set<int>>& rows) {
  std::size_t sum = 0;
  for (const auto& column : rows) sum += column.size();
  return sum;
}

TEST(IncrementalOrder, HasLittleFillAndKeepsTheLastTwo) {
  RandomStream random(1, "order");
  MinimumDegree minimum_degree;
  for (const int n : {3, 4, 20, 65, 300}) {
    const RestGraph graph = random_graph(std::max(n, 5), n / 4, random);
    const int newest = graph.size / 2;
    const int fixed = graph.size - 1;
    const std::vector<int> order = minimum_degree.order(graph, newest, fixed);
    ASSERT_EQ(order.size(), static_cast<std::size_t>(graph.size));
    EXPECT_EQ(order[order.size() - 1], fixed);
    EXPECT_EQ(order[order.size() - 2], newest);
    std::vector<int> position(order.size(), -1);
    for (std::size_t p = 0; p < order.size(); ++p) position[at(order[p])] = static_cast<int>(p);
    EXPECT_EQ(std::count(position.begin(), position.end(), -1), 0);
    std::vector<int> as_given(order.size());
    std::iota(as_given.begin(), as_given.end(), 0);
    if (n >= 65) {
      EXPECT_LT(count(naive_fill(graph, position)), count(naive_fill(graph, as_given)) / 2);
    }
  }
}

TEST(IncrementalOrder, OfAChainIsFlat) {
  RestGraph chain;
  chain.size = 1001;
  chain.links.push_back({1000, 0});
  for (int k = 1; k < 1000; ++k) chain.links.push_back({k - 1, k});
  MinimumDegree minimum_degree;
  const std::vector<int> order = minimum_degree.order(chain, 999, 1000);
  Elimination elimination;
  elimination.analyse(chain, order);
  // Of a front: how many lie above it.
  std::vector<int> front_of(1001, -1);
  for (std::size_t f = 0; f < elimination.fronts().size(); ++f) {
    const Front& front = elimination.fronts()[f];
    for (int j = 0; j < front.width; ++j) front_of[at(front.first + j)] = static_cast<int>(f);
  }
  int deepest = 0;
  for (std::size_t f = 0; f < elimination.fronts().size(); ++f) {
    int depth = 0;
    for (int up = static_cast<int>(f); up >= 0;) {
      const Front& front = elimination.fronts()[at(up)];
      up = front_of[at(elimination.row(front.rows))];
      ++depth;
    }
    deepest = std::max(deepest, depth);
  }
  EXPECT_LE(deepest, 12);
}

TEST(IncrementalElimination, HasTheRowsThatEliminationMakes) {
  RandomStream random(2, "elimination");
  MinimumDegree minimum_degree;
  Elimination elimination;
  for (const int n : {5, 12, 70, 2500}) {
    const RestGraph graph = random_graph(n, n / 10, random);
    elimination.analyse(graph, minimum_degree.order(graph, 2, n - 1));
    std::vector<int> position(at(n), -1);
    for (int p = 0; p < n; ++p) position[at(elimination.node_at(p))] = p;
    const auto rows = naive_fill(graph, position);
    int next = 0;
    std::size_t blocks = 0;
    for (const Front& front : elimination.fronts()) {
      EXPECT_EQ(front.first, next);
      next += front.width;
      std::set<int> has;
      for (int j = 0; j < front.height; ++j) has.insert(elimination.row(front.rows + at(j)));
      ASSERT_EQ(has.size(), at(front.height));
      EXPECT_EQ(has, rows[at(next - 1)]);
      for (int j = 0; j < front.width; ++j) {
        has.insert(front.first + j);
        for (const int row : rows[at(front.first + j)]) {
          EXPECT_TRUE(row < next || has.contains(row));
        }
      }
      blocks += at(front.width) * (at(front.width) - 1) / 2 + at(front.width) * at(front.height);
    }
    EXPECT_EQ(next, n - 1);
    EXPECT_LE(blocks, 2 * count(rows));
  }
}

// Grown as an estimator grows it: some keyframes, then loops, again and again.
struct Grown {
  Problem problem{make_node(1.0, 2.0, 3.0)};
  CliqueTree tree{problem};
  RandomStream random{3, "grown"};

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

TEST(IncrementalTree, IsTheFactorOfTheWholeMatrixHoweverItGrew) {
  Grown grown;
  for (const int keyframes : {6, 1, 4, 12, 1, 1, 30, 2}) {
    ASSERT_TRUE(grown.update(keyframes, 3));
    const Eigen::MatrixXd inverse = grown.dense().inverse();
    const std::vector<Vec3> gradient = grown.small_gradient();
    const Eigen::VectorXd g = Grown::stacked(gradient);
    const double promised = g.dot(inverse * g);
    EXPECT_NEAR(grown.tree.forward_all(gradient), promised, 1e-8 * promised);
    const Problem before = grown.problem;
    grown.tree.descend(0.0);
    const Eigen::VectorXd step = -inverse * g;
    double worst = 0.0;
    for (int k = 1; k < before.size(); ++k) {
      double d[3];
      offset_of(before.nodes[at(k)], grown.problem.nodes[at(k)], d);
      for (int a = 0; a < 3; ++a) worst = std::max(worst, std::abs(d[a] - step(3 * (k - 1) + a)));
    }
    EXPECT_LT(worst, 1e-5 * step.cwiseAbs().maxCoeff());
    grown.problem.nodes = before.nodes;
  }
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
  EXPECT_NEAR(grown.tree.forward(keyframes, gradient, ignored), promised, 1e-8 * promised);
  // What is ignored is left out of b.
  EXPECT_NEAR(grown.tree.forward(keyframes, gradient, gradient), 0.0, 1e-30);

  const Eigen::Matrix3d J_i = Eigen::Matrix3d::Random();
  const Eigen::Matrix3d J_k = Eigen::Matrix3d::Random();
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, inverse.cols());
  J.middleCols<3>(3 * (11 - 1)) = J_i;
  J.middleCols<3>(3 * (36 - 1)) = J_k;
  const Eigen::Matrix3d expected = J * inverse * J.transpose();
  EXPECT_LT((grown.tree.variance(11, J_i, 36, J_k) - expected).norm(), 1e-8 * expected.norm());
  J.middleCols<3>(3 * (11 - 1)).setZero();
  const Eigen::Matrix3d from_fixed = J * inverse * J.transpose();
  EXPECT_LT((grown.tree.variance(0, J_i, 36, J_k) - from_fixed).norm(), 1e-8 * from_fixed.norm());
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
  EXPECT_NEAR(grown.tree.forward_all(gradient), stale, 1e-8 * stale);
  grown.tree.descend(0.0);
  std::vector<int> keyframes;
  grown.tree.find_stale(1e-3, 1e-3, keyframes);
  ASSERT_TRUE(grown.tree.refresh(keyframes));
  EXPECT_NEAR(grown.tree.forward_all(gradient), fresh, 1e-5 * fresh);
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
  const Problem before = grown.problem;
  grown.tree.forward(keyframes, gradient, ignored);
  grown.tree.descend(1e-9);
  for (int k = 11; k <= 40; ++k) {
    double was[3];
    double now[3];
    offset_of(before.nodes[10], before.nodes[at(k)], was);
    offset_of(grown.problem.nodes[10], grown.problem.nodes[at(k)], now);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(now[a], was[a], 3e-5) << k;
  }
  double moved_by[3];
  offset_of(before.nodes[40], grown.problem.nodes[40], moved_by);
  EXPECT_GT(std::hypot(moved_by[0], moved_by[1]), 3e-4);
  EXPECT_LT(grown.tree.bent().size(), 30U);
  EXPECT_EQ(grown.tree.moved().size(), 40U);
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
