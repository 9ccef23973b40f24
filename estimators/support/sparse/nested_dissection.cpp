#include "estimators/support/sparse/nested_dissection.hpp"

#ifdef FATHOM_SCOTCH

#include <cstddef>
#include <utility>

// scotch.h needs what it does not include.
#include <cstdint>
#include <cstdio>
#include <scotch.h>

namespace fathom::sparse {
namespace {

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
#define FATHOM_SEPARATORS "m{rat=0.8,vert=100,low=h{pass=10}f{bal=0.6},asc=f{bal=0.6,move=120}}"
constexpr const char* kWhole =
    "n{sep=/(vert>120)?" FATHOM_SEPARATORS ";,ole=d{cmin=0,cmax=100000,frat=0.0},ose=g}";
// The separators of the first two levels alone.
constexpr const char* kTop = "n{sep=/((levl<2)&(vert>120))?" FATHOM_SEPARATORS ";,ole=s,ose=g}";
#undef FATHOM_SEPARATORS

// Nodes in an order of elimination, in blocks that follow each other: separators, each behind those
// that it separates, and the parts that are left.
struct Dissection {
  std::vector<int> order;
  std::vector<int> blocks{0};  ///< where each begins; the last: where all end
  std::vector<bool> is_part;
};

// On one thread and from the same seed, so that the order is always the same. Empty where SCOTCH
// fails.
Dissection dissected(const Adjacency& graph, const char* text) {
  std::vector<SCOTCH_Num> start(graph.start.begin(), graph.start.end());
  std::vector<SCOTCH_Num> neighbours(graph.neighbours.begin(), graph.neighbours.end());
  std::vector<SCOTCH_Num> order(at(graph.size()));
  std::vector<SCOTCH_Num> begins(at(graph.size()) + 1);
  std::vector<SCOTCH_Num> parents(at(graph.size()));
  SCOTCH_Num count = 0;
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
      SCOTCH_stratGraphOrder(&strategy, text) == 0 &&
      SCOTCH_graphOrder(&bound, &strategy, nullptr, order.data(), &count, begins.data(),
                        parents.data()) == 0;
  if (!is_done) return {};
  Dissection done;
  done.order.assign(order.begin(), order.end());
  done.blocks.assign(begins.begin(), begins.begin() + count + 1);
  done.is_part.assign(static_cast<std::size_t>(count), true);
  for (SCOTCH_Num b = 0; b < count; ++b) {
    if (const SCOTCH_Num parent = parents[static_cast<std::size_t>(b)]; parent >= 0) {
      done.is_part[static_cast<std::size_t>(parent)] = false;
    }
  }
  return done;
}

// The graph among nodes order[begin] … order[end − 1]; `place` of a node is where it stands there.
Adjacency induced(const Adjacency& graph, const std::vector<int>& order,
                  const std::vector<int>& place, int begin, int end) {
  Adjacency part;
  part.start.push_back(0);
  for (int i = begin; i < end; ++i) {
    const int v = order[at(i)];
    for (int j = graph.start[at(v)]; j < graph.start[at(v) + 1]; ++j) {
      const int w = place[at(graph.neighbours[at(j)])];
      if (w >= begin && w < end) part.neighbours.push_back(w - begin);
    }
    part.start.push_back(static_cast<int>(part.neighbours.size()));
  }
  return part;
}

// Orders each part of the first dissection by itself. False where SCOTCH fails.
bool order_parts(const Adjacency& graph, Workers* workers, Dissection& top) {
  std::vector<int> place(top.order.size());
  for (std::size_t i = 0; i < place.size(); ++i) place[at(top.order[i])] = static_cast<int>(i);
  const std::vector<int> first = top.order;
  std::vector<char> is_done(top.is_part.size(), 1);
  for_ranges(workers, top.is_part.size(), 1, [&](std::size_t from, std::size_t to) {
    for (std::size_t b = from; b < to; ++b) {
      const int begin = top.blocks[b];
      const int end = top.blocks[b + 1];
      if (!top.is_part[b] || begin == end) continue;
      const std::vector<int> own =
          dissected(induced(graph, first, place, begin, end), kWhole).order;
      is_done[b] = own.empty() ? 0 : 1;
      for (std::size_t i = 0; i < own.size(); ++i) {
        top.order[at(begin) + i] = first[at(begin + own[i])];
      }
    }
  });
  for (const char done : is_done) {
    if (done == 0) return false;
  }
  return true;
}

}  // namespace

bool has_nested_dissection() {
  return true;
}

std::vector<int> nested_dissection_order(const Adjacency& graph, Workers* workers) {
  Dissection top = dissected(graph, kTop);
  if (top.order.empty() || !order_parts(graph, workers, top)) return {};
  return std::move(top.order);
}

}  // namespace fathom::sparse

#else

namespace fathom::sparse {

bool has_nested_dissection() {
  return false;
}

std::vector<int> nested_dissection_order(const Adjacency& /*graph*/, Workers* /*workers*/) {
  return {};
}

}  // namespace fathom::sparse

#endif
