#pragma once

#include <algorithm>
#include <cmath>

#include "estimators/support/pose_graph/chain_front.hpp"

/// The arithmetic of ChainEquations, inlined into functions compiled for the processor at hand.
namespace fathom::pose_graph {

struct OneChain {
  const ChainGraph& graph;
  const ChainGraph::Chain& chain;
  const Node* nodes;  ///< of its keyframes
  EliminatedKeyframe* inside;
  PairTerms& terms;
  ChainSums& sums;
  double damping;
};

/// Both sides of a chain on the way to its middle.
template <Hessian kHessian>
struct ChainElimination : OneChain {
  ChainFront from_begin = {};
  ChainFront from_end = {};
  Four at_begin[3] = {};
  Four at_end[3] = {};

  FATHOM_INLINE PairTerms step(int t) const {
    PairTerms of_step = pair_terms<kHessian>(
        linearise_edge(graph.step(chain, t), nodes[t], nodes[t + 1], kLeverOf<kHessian>));
    if (damping != 0.0) scale_diagonals(1.0 + damping, of_step);
    return of_step;
  }

  FATHOM_INLINE static void scale_diagonals(double factor, PairTerms& t) {
    for (const std::size_t a : {0U, 3U, 5U}) {
      t.H_from[a] *= factor;
      t.H_to[a] *= factor;
    }
  }

  FATHOM_INLINE void run() {
    sums = {};
    const int count = chain.count - 1;
    PairTerms first = step(0);
    sums.g_from = first.g_from;
    if (count == 0) {
      sums.g_to = first.g_to;
      terms = first;
      undamp();
      return;
    }
    const PairTerms last = step(count);
    sums.g_to = last.g_to;
    terms.cost = first.cost + last.cost;
    set_rows(first.H_from, first.g_from, at_begin);
    add(first.H_to, {}, from_begin);
    set_columns(first.H_cross, first.g_to, from_begin.B);
    set_rows(last.H_to, last.g_to, at_end);
    add(last.H_from, {}, from_end);
    set_rows(last.H_cross, last.g_from, from_end.B);
    const int before = (count - 1) / 2;
    const int behind = count - 1 - before;
    for (int i = 0; i < behind; ++i) {
      if (i < before) forward(1 + i);
      backward(count - i);
    }
    meet(1 + before);
    undamp();
  }

  // The equations that take the terms multiply their diagonal.
  FATHOM_INLINE void undamp() {
    if (damping != 0.0) scale_diagonals(1.0 / (1.0 + damping), terms);
  }

  // Keyframe k of the side that comes from the begin.
  FATHOM_INLINE void forward(int k) {
    const PairTerms next = step(k);
    terms.cost += next.cost;
    Four E[3] = {};
    set_rows(next.H_cross, {}, E);
    add(next.H_from, next.g_from, from_begin);
    ChainFront after;
    add(next.H_to, next.g_to, after);
    eliminate(from_begin, E, inside[k - 1], at_begin, after, sums);
    from_begin = after;
  }

  FATHOM_INLINE void backward(int k) {
    const PairTerms next = step(k - 1);
    terms.cost += next.cost;
    Four E[3] = {};
    set_columns(next.H_cross, {}, E);
    add(next.H_to, next.g_to, from_end);
    ChainFront after;
    add(next.H_from, next.g_from, after);
    eliminate(from_end, E, inside[k - 1], at_end, after, sums);
    from_end = after;
  }

  // The keyframe in the middle has both ends as neighbours.
  FATHOM_INLINE void meet(int k) {
    Four E[3] = {};
    for (int a = 0; a < 3; ++a) {
      from_begin.D[a] += from_end.D[a];
      from_begin.B[a] += Four{0.0, 0.0, 0.0, from_end.B[a][3]};
      E[a] = from_end.B[a];
      E[a][3] = 0.0;
    }
    ChainFront end = {};
    for (int a = 0; a < 3; ++a) {
      end.D[a] = at_end[a];
      end.B[a] = Four{};
    }
    eliminate(from_begin, E, inside[k - 1], at_begin, end, sums);
    const auto upper = [](const Four(&rows)[3]) {
      return std::array{rows[0][0], rows[0][1], rows[0][2], rows[1][1], rows[1][2], rows[2][2]};
    };
    terms.H_from = upper(at_begin);
    terms.H_to = upper(end.D);
    for (int a = 0; a < 3; ++a) {
      terms.g_from[at(a)] = at_begin[a][3];
      terms.g_to[at(a)] = end.D[a][3] + end.B[a][3];
      for (int b = 0; b < 3; ++b) terms.H_cross[at(3 * b + a)] = end.B[a][b];
    }
  }
};

using ChainVector = std::array<double, 3>;

/// The gradient alone, with the factors as they are.
struct ChainDifferentiation : OneChain {
  FATHOM_INLINE PairTerms step(int t) const {
    return pair_terms<Hessian::gauss_newton>(
        linearise_edge(graph.step(chain, t), nodes[t], nodes[t + 1]));
  }

  FATHOM_INLINE void run() {
    sums = {};
    const int count = chain.count - 1;
    const PairTerms first = step(0);
    terms.cost = first.cost;
    terms.g_from = sums.g_from = first.g_from;
    if (count == 0) {
      terms.g_to = sums.g_to = first.g_to;
      return;
    }
    const PairTerms last = step(count);
    terms.cost += last.cost;
    terms.g_to = sums.g_to = last.g_to;
    ChainVector from_begin = first.g_to;
    ChainVector from_end = last.g_from;
    // What steps add to the gradients of the keyframes that come next, before the elimination.
    ChainVector raw_begin = first.g_to;
    ChainVector raw_end = last.g_from;
    const int before = (count - 1) / 2;
    const int behind = count - 1 - before;
    for (int i = 0; i < behind; ++i) {
      if (i < before) {
        const PairTerms next = step(1 + i);
        terms.cost += next.cost;
        note(raw_begin, next.g_from);
        raw_begin = next.g_to;
        add(next.g_from, from_begin);
        ChainVector after = next.g_to;
        substitute(inside[i], from_begin, terms.g_from, after);
        from_begin = after;
      }
      const PairTerms next = step(count - i - 1);
      terms.cost += next.cost;
      note(raw_end, next.g_to);
      raw_end = next.g_from;
      add(next.g_to, from_end);
      ChainVector after = next.g_from;
      substitute(inside[count - i - 1], from_end, terms.g_to, after);
      from_end = after;
    }
    note(raw_begin, raw_end);
    add(from_end, from_begin);
    substitute(inside[before], from_begin, terms.g_from, terms.g_to);
  }

  // The gradient of a keyframe, of its two steps.
  FATHOM_INLINE void note(const ChainVector& one, const ChainVector& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      sums.gradient_norm = std::max(sums.gradient_norm, std::abs(one[a] + other[a]));
    }
  }

  FATHOM_INLINE static void add(const ChainVector& more, ChainVector& sum) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += more[a];
  }

  FATHOM_INLINE void substitute(EliminatedKeyframe& keyframe, const ChainVector& g,
                                ChainVector& end, ChainVector& next) {
    const double y1 = g[1] - keyframe.l10 * g[0];
    const double y[3] = {g[0], y1, g[2] - keyframe.l20 * g[0] - keyframe.l21 * y1};
    for (int k = 0; k < 3; ++k) {
      const double z = keyframe.inverse[k] * y[k];
      sums.decrease += y[k] * z;
      keyframe.B[k][3] = z;
      for (int a = 0; a < 3; ++a) {
        end[at(a)] -= keyframe.B[k][a] * y[k];
        next[at(a)] -= keyframe.E[k][a] * y[k];
      }
    }
  }
};

/// The steps of the keyframes of a chain, −H⁻¹ g, for those of its ends.
FATHOM_INLINE ChainVector substitute_back(EliminatedKeyframe& keyframe, const ChainVector& end,
                                          const ChainVector& next) {
  ChainVector x{};
  for (int k = 0; k < 3; ++k) {
    double sum = -keyframe.B[k][3];
    for (int a = 0; a < 3; ++a) {
      sum -= keyframe.B[k][a] * end[at(a)];
    }
    for (int a = 0; a < 3; ++a) sum -= keyframe.E[k][a] * next[at(a)];
    x[at(k)] = sum;
  }
  x[1] -= keyframe.l21 * x[2];
  x[0] -= keyframe.l10 * x[1] + keyframe.l20 * x[2];
  for (int k = 0; k < 3; ++k) keyframe.E[k][3] = x[at(k)];
  return x;
}

FATHOM_INLINE void substitute_back(std::span<EliminatedKeyframe> inside, const ChainVector& begin,
                                   const ChainVector& end) {
  if (inside.empty()) return;
  const int count = static_cast<int>(inside.size());
  const int before = (count - 1) / 2;
  const int behind = count - 1 - before;
  ChainVector left = substitute_back(inside[at(before)], begin, end);
  ChainVector right = left;
  for (int i = 0; i < behind; ++i) {
    if (i < before) left = substitute_back(inside[at(before - 1 - i)], begin, left);
    right = substitute_back(inside[at(before + 1 + i)], end, right);
  }
}

}  // namespace fathom::pose_graph
