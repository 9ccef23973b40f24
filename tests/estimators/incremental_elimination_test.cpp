// The order and the pattern that incremental_smoother eliminates by, against elimination of sets.

#include <algorithm>
#include <numeric>
#include <set>

#include <gtest/gtest.h>

#include "estimators/incremental_smoother/elimination.hpp"
#include "fathom/core/random.hpp"

namespace fathom::incremental_smoother {
namespace {

// A trajectory 0 … n − 2, keyframe 0 being the fixed node n − 1, with loops and an element.
QuotientGraph random_graph(int n, int loops, RandomStream& random) {
  QuotientGraph graph;
  graph.size = n;
  graph.links.push_back({n - 1, 0});
  for (int k = 1; k + 1 < n; ++k) graph.links.push_back({k - 1, k});
  const auto any = [&] { return std::min(n - 1, static_cast<int>(random.uniform(0.0, n))); };
  for (int j = 0; j < loops; ++j) {
    const int a = any();
    const int b = any();
    if (a != b) graph.links.push_back({a, b});
  }
  std::set<int> element;
  while (element.size() < 4) element.insert(any());
  graph.element_nodes.assign(element.begin(), element.end());
  graph.element_start.push_back(static_cast<int>(graph.element_nodes.size()));
  return graph;
}

// Rows below each column of the factor, by elimination of sets.
std::vector<std::set<int>> naive_fill(const QuotientGraph& graph,
                                      const std::vector<int>& position) {
  std::vector<std::set<int>> rows(static_cast<std::size_t>(graph.size));
  const auto link = [&](int a, int b) {
    const auto [first, second] = std::minmax(position[at(a)], position[at(b)]);
    if (first != second) rows[at(first)].insert(second);
  };
  for (const auto& l : graph.links) link(l.a, l.b);
  for (const int a : graph.element_nodes) {
    for (const int b : graph.element_nodes) link(a, b);
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
    const QuotientGraph graph = random_graph(std::max(n, 5), n / 4, random);
    const int newest = graph.size / 2;
    const int fixed = graph.size - 1;
    const std::vector<int> order = minimum_degree.order(graph, 0, newest, fixed);
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

TEST(IncrementalOrder, TakesTheFirstBeforeAllOthers) {
  RandomStream random(3, "first");
  MinimumDegree minimum_degree;
  for (const int n : {20, 65, 300}) {
    const QuotientGraph graph = random_graph(n, n / 4, random);
    for (const int first : {1, n / 3, n - 3}) {
      const std::vector<int> order = minimum_degree.order(graph, first, n - 2, n - 1);
      std::vector<int> sorted = order;
      const auto end = sorted.begin() + first;
      std::sort(sorted.begin(), end);
      std::sort(end, sorted.end());
      for (int v = 0; v < n; ++v) ASSERT_EQ(sorted[at(v)], v);
      EXPECT_EQ(order[order.size() - 2], n - 2);
      EXPECT_EQ(order.back(), n - 1);
    }
  }
}

TEST(IncrementalOrder, OfAChainIsFlat) {
  QuotientGraph chain;
  chain.size = 1001;
  chain.links.push_back({1000, 0});
  for (int k = 1; k < 1000; ++k) chain.links.push_back({k - 1, k});
  MinimumDegree minimum_degree;
  const std::vector<int> order = minimum_degree.order(chain, 0, 999, 1000);
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
    const QuotientGraph graph = random_graph(n, n / 10, random);
    elimination.analyse(graph, minimum_degree.order(graph, 0, 2, n - 1));
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

}  // namespace
}  // namespace fathom::incremental_smoother
