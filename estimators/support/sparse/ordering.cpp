#include "estimators/support/sparse/ordering.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#ifdef FATHOM_SCOTCH
// scotch.h needs what it does not include.
#include <cstdio>
#include <scotch.h>
#endif

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

#ifdef FATHOM_SCOTCH
// What SCOTCH opens and closes.
template <class T, int (*open)(T*), void (*close)(T*)>
struct Opened : T {
  Opened() : is_open(open(this) == 0) {}
  Opened(const Opened&) = delete;
  Opened& operator=(const Opened&) = delete;
  ~Opened() {
    if (is_open) close(this);
  }

  bool is_open;
};

// Nested dissection by multilevel separators, Fiduccia and Mattheyses' refinement at each level,
// down to 120 nodes, which are ordered by minimum degree. Blocks are left to make_supernodes, where
// SCOTCH's own strategy merges columns (cmin). The numbers were chosen on the survey of `back_ends`
// with 10⁵ to 10⁶ keyframes: docs/cost.md has what they change on other graphs.
constexpr const char* kStrategy =
    "n{sep=/(vert>120)?m{rat=0.8,vert=100,low=h{pass=10}f{bal=0.6},asc=f{bal=0.6,move=120}};,"
    "ole=d{cmin=0,cmax=100000,frat=0.0},ose=g}";

// On one thread and from the same seed, so that the order is always the same. Empty where SCOTCH
// fails.
std::vector<int> nested_dissection_order(const Adjacency& graph) {
  std::vector<SCOTCH_Num> start(graph.start.begin(), graph.start.end());
  std::vector<SCOTCH_Num> neighbours(graph.neighbours.begin(), graph.neighbours.end());
  std::vector<SCOTCH_Num> order(at(graph.size()));
  Opened<SCOTCH_Context, SCOTCH_contextInit, SCOTCH_contextExit> context;
  Opened<SCOTCH_Graph, SCOTCH_graphInit, SCOTCH_graphExit> own;
  Opened<SCOTCH_Graph, SCOTCH_graphInit, SCOTCH_graphExit> bound;
  Opened<SCOTCH_Strat, SCOTCH_stratInit, SCOTCH_stratExit> strategy;
  if (!context.is_open || !own.is_open || !bound.is_open || !strategy.is_open) return {};
  // Draws of its own, not those of the process.
  if (SCOTCH_contextRandomClone(&context) != 0) return {};
  SCOTCH_contextRandomSeed(&context, 1);
  const bool is_done =
      SCOTCH_contextOptionSetNum(&context, SCOTCH_OPTIONNUMDETERMINISTIC, 1) == 0 &&
      SCOTCH_contextOptionSetNum(&context, SCOTCH_OPTIONNUMRANDOMFIXEDSEED, 1) == 0 &&
      SCOTCH_contextThreadSpawn(&context, 1, nullptr) == 0 &&
      SCOTCH_graphBuild(&own, 0, graph.size(), start.data(), nullptr, nullptr, nullptr,
                        start[at(graph.size())], neighbours.data(), nullptr) == 0 &&
      SCOTCH_contextBindGraph(&context, &own, &bound) == 0 &&
      SCOTCH_stratGraphOrder(&strategy, kStrategy) == 0 &&
      SCOTCH_graphOrder(&bound, &strategy, nullptr, order.data(), nullptr, nullptr, nullptr) == 0;
  if (!is_done) return {};
  return {order.begin(), order.end()};
}
#else
std::vector<int> nested_dissection_order(const Adjacency& /*graph*/) {
  return {};
}
#endif

void order_rest(const ShrinkingGraph& graph, Ordering ordering, std::vector<int>& order) {
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
    if (!left.neighbours.empty()) of_rest = nested_dissection_order(left);
  }
  if (of_rest.empty()) of_rest = minimum_degree_order(lower);
  for (const int v : of_rest) order.push_back(rest[at(v)]);
}

}  // namespace

bool has_nested_dissection() {
#ifdef FATHOM_SCOTCH
  return true;
#else
  return false;
#endif
}

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

std::vector<int> elimination_order(Adjacency graph, ChainElimination chains, Ordering ordering) {
  ShrinkingGraph shrinking(std::move(graph));
  std::vector<int> order;
  order.reserve(at(shrinking.size()));
  if (chains == ChainElimination::on) eliminate_chains(shrinking, order);
  order_rest(shrinking, ordering, order);
  return order;
}

}  // namespace fathom::sparse
