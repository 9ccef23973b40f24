// Orders of elimination: nested dissection, and where it is taken.

#include <algorithm>
#include <bitset>
#include <map>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "estimators/support/sparse/block_cholesky.hpp"
#include "estimators/support/sparse/nested_dissection.hpp"
#include "fathom/core/random.hpp"

namespace fathom::sparse {
namespace {

// All that are side by side in a box of so many nodes along each axis.
std::vector<Link> box_of(int width, int height, int depth) {
  std::vector<Link> links;
  for (int v = 0; v < width * height * depth; ++v) {
    if (v % width > 0) links.push_back({v - 1, v});
    if (v / width % height > 0) links.push_back({v - width, v});
    if (v >= width * height) links.push_back({v - width * height, v});
  }
  return links;
}

constexpr int kVisits = 3500;

// Of somebody who walks about in 10 × 10 rooms, and in each remembers two earlier visits: minimum
// degree finds no small separators in it.
std::vector<Link> revisits() {
  RandomStream random(5, "rooms");
  std::map<std::pair<int, int>, std::vector<int>> visits;
  std::vector<Link> links;
  int x = 5;
  int y = 5;
  for (int k = 0; k < kVisits; ++k) {
    std::vector<int>& here = visits[{x, y}];
    for (int i = 0; i < 2 && !here.empty(); ++i)
      links.push_back({here[random.index(here.size())], k});
    if (k > 0) links.push_back({k - 1, k});
    here.push_back(k);
    int& along = random.uniform() < 0.5 ? x : y;
    along = std::clamp(along + (random.uniform() < 0.5 ? 1 : -1), 0, 9);
  }
  return links;
}

// By elimination of one node after the other.
double multiplications_one_by_one(const Adjacency& graph, const std::vector<int>& order) {
  using Nodes = std::bitset<4096>;
  std::vector<Nodes> neighbours(at(graph.size()));
  for (int v = 0; v < graph.size(); ++v) {
    for (int p = graph.start[at(v)]; p < graph.start[at(v) + 1]; ++p) {
      neighbours[at(v)].set(at(graph.neighbours[at(p)]));
    }
  }
  Nodes left;
  left.set();
  double sum = 0.0;
  for (const int v : order) {
    left.reset(at(v));
    const Nodes below = neighbours[at(v)] & left;
    const auto panel = static_cast<double>(below.count() + 1);
    sum += 0.5 * panel * (panel + 1.0);
    for (std::size_t a = 0; a < neighbours.size(); ++a) {
      if (below[a]) (neighbours[a] |= below).reset(a);
    }
  }
  return sum;
}

constexpr const char* kWithout = "built without SCOTCH";

std::vector<int> dissected(const Adjacency& graph) {
  return elimination_order(graph, ChainElimination::on, Ordering::nested_dissection);
}

TEST(Ordering, DissectionTakesEveryNodeOnceAndIsRepeatable) {
  if (!has_nested_dissection()) GTEST_SKIP() << kWithout;
  const Adjacency graph = adjacency_of(400, box_of(20, 20, 1));
  const std::vector<int> order = dissected(graph);
  EXPECT_NE(order, elimination_order(graph, ChainElimination::on));
  std::vector<std::vector<int>> again(4);
  std::vector<std::thread> threads;
  for (auto& one : again) threads.emplace_back([&graph, &one] { one = dissected(graph); });
  for (std::thread& thread : threads) thread.join();
  for (const auto& one : again) EXPECT_EQ(one, order);
  std::vector<int> nodes = order;
  std::sort(nodes.begin(), nodes.end());
  for (int v = 0; v < 400; ++v) EXPECT_EQ(nodes[at(v)], v);
}

// Grids beside each other, a ring without a grid, and a node alone: what dissects into more parts
// or fewer.
TEST(Ordering, WorkersDissectInTheSameOrder) {
  if (!has_nested_dissection()) GTEST_SKIP() << kWithout;
  std::vector<Link> links = box_of(60, 45, 1);
  int nodes = 2700;
  for (const Link& link : box_of(40, 20, 1)) links.push_back({nodes + link.a, nodes + link.b});
  nodes += 800;
  for (int v = 0; v < 300; ++v) links.push_back({nodes + v, nodes + (v + 1) % 300});
  nodes += 301;
  const Adjacency graph = adjacency_of(nodes, links);
  const std::vector<int> order = nested_dissection_order(graph, nullptr);
  for (const int threads : {2, 3, 7}) {
    Workers workers(threads);
    EXPECT_EQ(nested_dissection_order(graph, &workers), order) << threads;
  }
  std::vector<int> sorted = order;
  std::sort(sorted.begin(), sorted.end());
  ASSERT_EQ(sorted.size(), at(nodes));
  for (int v = 0; v < nodes; ++v) EXPECT_EQ(sorted[at(v)], v);
  EXPECT_LT(
      multiplications_one_by_one(graph, order),
      1.1 * multiplications_one_by_one(graph, elimination_order(graph, ChainElimination::on)));
}

TEST(Ordering, DissectionOfAFewNodes) {
  EXPECT_EQ(dissected(adjacency_of(0, {})).size(), 0U);
  EXPECT_EQ(dissected(adjacency_of(1, {})).size(), 1U);
  EXPECT_EQ(dissected(adjacency_of(5, {{0, 4}})).size(), 5U);
  EXPECT_EQ(
      elimination_order(adjacency_of(3, {}), ChainElimination::off, Ordering::nested_dissection)
          .size(),
      3U);
  std::vector<Link> complete;
  for (int a = 0; a < 6; ++a) {
    for (int b = 0; b < a; ++b) complete.push_back({b, a});
  }
  EXPECT_EQ(dissected(adjacency_of(6, complete)).size(), 6U);
}

// To sort an order along its tree changes no arithmetic.
TEST(Ordering, IsDissectedWhereThatSavesArithmetic) {
  if (!has_nested_dissection()) GTEST_SKIP() << kWithout;
  const Adjacency graph = adjacency_of(kVisits, revisits());
  const double taken = multiplications_one_by_one(graph, analyse(graph).node);
  EXPECT_EQ(taken, multiplications_one_by_one(graph, dissected(graph)));
  EXPECT_LT(taken, 0.9 * multiplications_one_by_one(
                             graph, elimination_order(graph, ChainElimination::on)));
}

TEST(Ordering, IsNotDissectedWhereThatCostsMoreThanItSaves) {
  if (!has_nested_dissection()) GTEST_SKIP() << kWithout;
  const Adjacency grid = adjacency_of(1600, box_of(40, 40, 1));
  const double taken = multiplications_one_by_one(grid, analyse(grid).node);
  EXPECT_EQ(taken, multiplications_one_by_one(grid, elimination_order(grid, ChainElimination::on)));
  EXPECT_NE(taken, multiplications_one_by_one(grid, dissected(grid)));
}

TEST(BlockCholesky, SolvesADissectedGraph) {
  const std::vector<Link> links = revisits();
  const Symbolic symbolic = analyse(adjacency_of(kVisits, links));
  BlockCholesky<3> poses(symbolic);
  BlockCholesky<1> factor(poses);  // in the memory of the other
  EXPECT_EQ(factor.data(), poses.data());
  factor.clear();
  const auto put = [&](int a, int b, double value) {
    factor.data()[factor.place(a, b).offset] += value;
  };
  std::vector<double> x(kVisits, 0.0);
  for (int v = 0; v < kVisits; ++v) x[at(symbolic.position[at(v)])] = 1.0 + 0.001 * v;
  std::vector<double> right(kVisits, 0.0);
  for (int v = 0; v < kVisits; ++v) {
    put(v, v, 0.5);
    right[at(symbolic.position[at(v)])] += 0.5 * x[at(symbolic.position[at(v)])];
  }
  for (const auto& [a, b] : links) {
    put(a, a, 1.0);
    put(b, b, 1.0);
    put(a, b, -1.0);
    const int at_a = symbolic.position[at(a)];
    const int at_b = symbolic.position[at(b)];
    right[at(at_a)] += x[at(at_a)] - x[at(at_b)];
    right[at(at_b)] += x[at(at_b)] - x[at(at_a)];
  }
  ASSERT_TRUE(factor.factorise());
  factor.solve(right.data());
  for (std::size_t i = 0; i < x.size(); ++i) ASSERT_NEAR(right[i], x[i], 1e-11);
}

}  // namespace
}  // namespace fathom::sparse
