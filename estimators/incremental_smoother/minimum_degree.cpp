#include "estimators/incremental_smoother/minimum_degree.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace fathom::incremental_smoother {
namespace {

constexpr int kMostBits = 2048;
constexpr int kWord = 64;

// use(node) for each bit of a row.
template <class Use>
void for_each_bit(const std::uint64_t* row, int words, Use use) {
  for (int w = 0; w < words; ++w) {
    for (std::uint64_t rest = row[w]; rest != 0; rest &= rest - 1) {
      use(w * kWord + std::countr_zero(rest));
    }
  }
}

void set(std::uint64_t* row, int v) {
  row[v / kWord] |= std::uint64_t{1} << (v % kWord);
}
void reset(std::uint64_t* row, int v) {
  row[v / kWord] &= ~(std::uint64_t{1} << (v % kWord));
}

}  // namespace

void QuotientGraph::clear() {
  size = 0;
  links.clear();
  element_start.assign(1, 0);
  element_nodes.clear();
}

const std::vector<int>& MinimumDegree::order(const QuotientGraph& graph, int first, int newest,
                                             int fixed) {
  order_.clear();
  if (graph.size <= kMostBits) {
    order_by_bits(graph, first, newest, fixed);
  } else {
    order_approximately(graph);
    std::erase_if(order_, [&](int v) { return v == newest || v == fixed; });
  }
  order_.push_back(newest);
  order_.push_back(fixed);
  return order_;
}

void MinimumDegree::fill_rows(const QuotientGraph& graph) {
  bits_.assign(at(graph.size) * at(words_), 0);
  mask_.resize(at(words_));
  for (const auto& link : graph.links) {
    set(row(link.a), link.b);
    set(row(link.b), link.a);
  }
  for (int g = 0; g < graph.elements(); ++g) {
    std::fill(mask_.begin(), mask_.end(), 0);
    const int begin = graph.element_start[at(g)];
    const int end = graph.element_start[at(g) + 1];
    for (int p = begin; p < end; ++p) set(mask_.data(), graph.element_nodes[at(p)]);
    for (int p = begin; p < end; ++p) {
      std::uint64_t* to = row(graph.element_nodes[at(p)]);
      for (int w = 0; w < words_; ++w) to[w] |= mask_[at(w)];
    }
  }
  for (int v = 0; v < graph.size; ++v) reset(row(v), v);
}

int MinimumDegree::count(int v) {
  int sum = 0;
  for (int w = 0; w < words_; ++w) sum += std::popcount(row(v)[w]);
  return sum;
}

// Behind the others of its degree: of a chain every second node goes first, then every second of
// the rest, so that its tree is flat and a change in the middle has few ancestors.
void MinimumDegree::put(int v) {
  const int d = degree_[at(v)];
  const int before = tail_[at(d)];
  previous_[at(v)] = before;
  next_[at(v)] = -1;
  tail_[at(d)] = v;
  if (before >= 0) {
    next_[at(before)] = v;
  } else {
    head_[at(d)] = v;
  }
}

void MinimumDegree::take(int v) {
  const int d = degree_[at(v)];
  const int before = previous_[at(v)];
  const int after = next_[at(v)];
  if (before >= 0) {
    next_[at(before)] = after;
  } else {
    head_[at(d)] = after;
  }
  if (after >= 0) {
    previous_[at(after)] = before;
  } else {
    tail_[at(d)] = before;
  }
}

void MinimumDegree::begin(const QuotientGraph& graph) {
  const int n = graph.size;
  words_ = (n + kWord - 1) / kWord;
  fill_rows(graph);
  degree_.assign(at(n), 0);
  next_.resize(at(n));
  previous_.resize(at(n));
  head_.assign(at(n), -1);
  tail_.assign(at(n), -1);
}

void MinimumDegree::order_by_bits(const QuotientGraph& graph, int first, int newest, int fixed) {
  const int n = graph.size;
  begin(graph);
  const auto is_kept = [&](int v) { return v == newest || v == fixed; };
  // Those whose turn it is; the others wait.
  int start = 0;
  int end = first > 0 ? first : n;
  const auto put_all = [&] {
    for (int v = start; v < end; ++v) {
      degree_[at(v)] = count(v);
      if (!is_kept(v)) put(v);
    }
  };
  put_all();
  int least = 0;
  for (int left = n; left > 2; --left) {
    if (left == n - first && first > 0) {
      start = std::exchange(end, n);
      put_all();
      least = 0;
    }
    while (head_[at(least)] < 0) ++least;
    const int v = head_[at(least)];
    // All that are left are linked with one another.
    if (least == left - 1) break;
    take(v);
    order_.push_back(v);
    const std::uint64_t* from = row(v);
    for_each_bit(from, words_, [&](int u) {
      std::uint64_t* to = row(u);
      for (int w = 0; w < words_; ++w) to[w] |= from[w];
      reset(to, u);
      reset(to, v);
      if (is_kept(u) || u < start || u >= end) return;
      take(u);
      degree_[at(u)] = count(u);
      put(u);
      least = std::min(least, degree_[at(u)]);
    });
    degree_[at(v)] = -1;
  }
  for (int v = 0; v < n; ++v) {
    if (!is_kept(v) && degree_[at(v)] >= 0) order_.push_back(v);
  }
}

void MinimumDegree::order_approximately(const QuotientGraph& graph) {
  std::vector<sparse::Link> links = graph.links;
  for (int g = 0; g < graph.elements(); ++g) {
    for (int p = graph.element_start[at(g)]; p < graph.element_start[at(g) + 1]; ++p) {
      for (int q = graph.element_start[at(g)]; q < p; ++q) {
        links.push_back({graph.element_nodes[at(p)], graph.element_nodes[at(q)]});
      }
    }
  }
  order_ = sparse::elimination_order(sparse::adjacency_of(graph.size, links),
                                     sparse::ChainElimination::on);
}

}  // namespace fathom::incremental_smoother
