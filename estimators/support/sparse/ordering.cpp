#include "estimators/support/sparse/ordering.hpp"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include "estimators/support/sparse/nested_dissection.hpp"

namespace fathom::sparse {
namespace {

// The graph while nodes are taken out of it. A node of at most two neighbours leaves at most one
// new link, in the place of the link to it, so no list ever grows.
class ShrinkingGraph {
 public:
  explicit ShrinkingGraph(Adjacency graph) : graph_(std::move(graph)), degree_(at(graph_.size())) {
    for (int v = 0; v < graph_.size(); ++v) {
      degree_[at(v)] = graph_.start[at(v) + 1] - graph_.start[at(v)];
    }
  }

  int size() const { return graph_.size(); }
  int degree(int v) const { return degree_[at(v)]; }
  int neighbour(int v, int j) const { return graph_.neighbours[at(graph_.start[at(v)] + j)]; }

  void eliminate(int v) {
    const int degree = degree_[at(v)];
    degree_[at(v)] = -1;
    if (degree == 1) {
      remove(neighbour(v, 0), find(neighbour(v, 0), v));
    } else if (degree == 2) {
      join(v, neighbour(v, 0), neighbour(v, 1));
    }
  }

 private:
  int& entry(int v, int j) { return graph_.neighbours[at(graph_.start[at(v)] + j)]; }
  int find(int v, int w) const {
    int j = 0;
    while (j < degree(v) && neighbour(v, j) != w) ++j;
    return j;
  }
  void remove(int v, int j) { entry(v, j) = entry(v, --degree_[at(v)]); }
  void join(int v, int a, int b) {
    if (degree(a) > degree(b)) std::swap(a, b);
    const bool linked = find(a, b) < degree(a);
    const int at_a = find(a, v);
    const int at_b = find(b, v);
    if (linked) {
      remove(a, at_a);
      remove(b, at_b);
    } else {
      entry(a, at_a) = b;
      entry(b, at_b) = a;
    }
  }

  Adjacency graph_;
  std::vector<int> degree_;
};

void eliminate_chains(ShrinkingGraph& graph, std::vector<int>& order) {
  std::vector<int> due;
  for (int first = 0; first < graph.size(); ++first) {
    due.push_back(first);
    while (!due.empty()) {
      const int v = due.back();
      due.pop_back();
      const int degree = graph.degree(v);
      if (degree < 0 || degree > 2) continue;
      const int a = degree > 0 ? graph.neighbour(v, 0) : v;
      const int b = degree > 1 ? graph.neighbour(v, 1) : v;
      graph.eliminate(v);
      order.push_back(v);
      // Later nodes come by themselves, so that a chain goes from one end to the other.
      for (const int w : {a, b}) {
        if (w < first) due.push_back(w);
      }
    }
  }
}

// The lower triangle of a symmetric pattern, by column, with its diagonal: AMD leaves a node
// without one to the end.
struct Pattern {
  std::vector<int> start{0};
  std::vector<int> rows;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

std::vector<int> minimum_degree_order(const Pattern& lower) {
  using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
  const std::vector<double> values(lower.rows.size(), 1.0);
  const Eigen::Map<const Matrix> matrix(lower.size(), lower.size(), lower.start.back(),
                                        lower.start.data(), lower.rows.data(), values.data());
  Eigen::AMDOrdering<int>::PermutationType amd;
  Eigen::AMDOrdering<int>()(Matrix(matrix).selfadjointView<Eigen::Lower>(), amd);
  return {amd.indices().begin(), amd.indices().end()};
}

void order_rest(const ShrinkingGraph& graph, Ordering ordering, Workers* workers,
                std::vector<int>& order) {
  std::vector<int> rest;
  std::vector<int> index(at(graph.size()), -1);
  for (int v = 0; v < graph.size(); ++v) {
    if (graph.degree(v) < 0) continue;
    index[at(v)] = static_cast<int>(rest.size());
    rest.push_back(v);
  }
  if (rest.empty()) return;
  Pattern lower;
  for (const int v : rest) {
    lower.rows.push_back(index[at(v)]);
    for (int j = 0; j < graph.degree(v); ++j) {
      const int w = graph.neighbour(v, j);
      if (w > v) lower.rows.push_back(index[at(w)]);
    }
    std::sort(lower.rows.begin() + lower.start.back(), lower.rows.end());
    lower.start.push_back(static_cast<int>(lower.rows.size()));
  }
  std::vector<int> of_rest;
  if (ordering == Ordering::nested_dissection) {
    Adjacency left;
    left.start.push_back(0);
    for (const int v : rest) {
      for (int j = 0; j < graph.degree(v); ++j) {
        left.neighbours.push_back(index[at(graph.neighbour(v, j))]);
      }
      left.start.push_back(static_cast<int>(left.neighbours.size()));
    }
    if (!left.neighbours.empty()) of_rest = nested_dissection_order(left, workers);
  }
  if (of_rest.empty()) of_rest = minimum_degree_order(lower);
  for (const int v : of_rest) order.push_back(rest[at(v)]);
}

}  // namespace

Adjacency adjacency_of(int n, const std::vector<Link>& links) {
  Adjacency graph;
  graph.start.assign(at(n) + 1, 0);
  for (const Link& link : links) {
    ++graph.start[at(link.a) + 1];
    ++graph.start[at(link.b) + 1];
  }
  std::partial_sum(graph.start.begin(), graph.start.end(), graph.start.begin());
  std::vector<int> all(2 * links.size());
  std::vector<int> next(graph.start.begin(), graph.start.end() - 1);
  for (const Link& link : links) {
    all[at(next[at(link.a)]++)] = link.b;
    all[at(next[at(link.b)]++)] = link.a;
  }
  std::vector<int> seen_by(at(n), -1);
  graph.neighbours.reserve(all.size());
  for (int v = 0; v < n; ++v) {
    const int begin = graph.start[at(v)];
    graph.start[at(v)] = static_cast<int>(graph.neighbours.size());
    for (int j = begin; j < next[at(v)]; ++j) {
      const int w = all[at(j)];
      if (w == v || seen_by[at(w)] == v) continue;
      seen_by[at(w)] = v;
      graph.neighbours.push_back(w);
    }
  }
  graph.start[at(n)] = static_cast<int>(graph.neighbours.size());
  return graph;
}

std::vector<int> elimination_order(Adjacency graph, ChainElimination chains, Ordering ordering,
                                   Workers* workers) {
  ShrinkingGraph shrinking(std::move(graph));
  std::vector<int> order;
  order.reserve(at(shrinking.size()));
  if (chains == ChainElimination::on) eliminate_chains(shrinking, order);
  order_rest(shrinking, ordering, workers, order);
  return order;
}

}  // namespace fathom::sparse
