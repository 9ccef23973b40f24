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
    start(reversed(first), from_begin, at_begin);
    start(last, from_end, at_end);
    const int before = (count - 1) / 2;
    const int behind = count - 1 - before;
    for (int i = 0; i < behind; ++i) {
      if (i < before) take(step(1 + i), inside[i], from_begin, at_begin);
      const int k = count - i;
      take(reversed(step(k - 1)), inside[k - 1], from_end, at_end);
    }
    meet(1 + before);
    undamp();
  }

  // The equations that take the terms multiply their diagonal.
  FATHOM_INLINE void undamp() {
    if (damping != 0.0) scale_diagonals(1.0 / (1.0 + damping), terms);
  }

  // A side, by the step from its first keyframe to the end of the chain.
  FATHOM_INLINE static void start(const PairTerms& t, ChainFront& front, Four (&end)[3]) {
    set_rows(t.H_to, t.g_to, end);
    add(t.H_from, {}, front);
    set_rows(t.H_cross, t.g_from, front.B);
  }

  // The next keyframe of a side, by its step to the one behind it.
  FATHOM_INLINE void take(const PairTerms& t, EliminatedKeyframe& keyframe, ChainFront& front,
                          Four (&end)[3]) {
    terms.cost += t.cost;
    Four E[3] = {};
    set_rows(t.H_cross, {}, E);
    add(t.H_from, t.g_from, front);
    ChainFront after;
    add(t.H_to, t.g_to, after);
    eliminate(front, E, keyframe, end, after, sums);
    front = after;
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
    ChainFront end;
    for (int a = 0; a < 3; ++a) end.D[a] = at_end[a];
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
    Side from_begin{first.g_to, first.g_to};
    Side from_end{last.g_from, last.g_from};
    const int before = (count - 1) / 2;
    const int behind = count - 1 - before;
    for (int i = 0; i < behind; ++i) {
      if (i < before) take(step(1 + i), inside[i], from_begin, terms.g_from);
      const int k = count - i;
      take(reversed(step(k - 1)), inside[k - 1], from_end, terms.g_to);
    }
    note(from_begin.raw, from_end.raw);
    add(from_end.g, from_begin.g);
    substitute(inside[before], from_begin.g, terms.g_from, terms.g_to);
  }

  // What is known of the gradient of the next keyframe, and what it is before the elimination.
  struct Side {
    ChainVector g;
    ChainVector raw;
  };

  // As of ChainElimination.
  FATHOM_INLINE void take(const PairTerms& t, EliminatedKeyframe& keyframe, Side& side,
                          ChainVector& end) {
    terms.cost += t.cost;
    note(side.raw, t.g_from);
    add(t.g_from, side.g);
    ChainVector after = t.g_to;
    substitute(keyframe, side.g, end, after);
    side = {after, t.g_to};
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
    for (int a = 0; a < 3; ++a) sum -= keyframe.B[k][a] * end[at(a)];
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
