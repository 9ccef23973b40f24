#pragma once

#include <cmath>

#include "estimators/support/pose_graph/chain_equations.hpp"
#include "estimators/support/sparse/dense_kernel.hpp"

/// One keyframe of a chain, inlined into functions compiled for the processor at hand.
namespace fathom::pose_graph {

using sparse::Four;
using sparse::FourAnywhere;

/// A keyframe before its elimination.
struct ChainFront {
  Four D[3] = {};  ///< rows of its own block
  Four B[3] = {};  ///< of its block with an end of the chain; last column: of the gradient
};

FATHOM_INLINE void set_rows(const std::array<double, 6>& H, const std::array<double, 3>& last,
                            Four (&rows)[3]) {
  rows[0] = Four{H[0], H[1], H[2], last[0]};
  rows[1] = Four{H[1], H[3], H[4], last[1]};
  rows[2] = Four{H[2], H[4], H[5], last[2]};
}

/// A keyframe's own block and gradient.
FATHOM_INLINE void add(const std::array<double, 6>& H, const std::array<double, 3>& g,
                       ChainFront& front) {
  front.D[0] += Four{H[0], H[1], H[2], 0.0};
  front.D[1] += Four{H[1], H[3], H[4], 0.0};
  front.D[2] += Four{H[2], H[4], H[5], 0.0};
  for (std::size_t a = 0; a < 3; ++a) front.B[a] += Four{0.0, 0.0, 0.0, g[a]};
}

FATHOM_INLINE void set_rows(const std::array<double, 9>& X, const std::array<double, 3>& last,
                            Four (&rows)[3]) {
  for (std::size_t a = 0; a < 3; ++a) rows[a] = Four{X[3 * a], X[3 * a + 1], X[3 * a + 2], last[a]};
}

/// Eliminates a keyframe whose block with the next one is E: D − BᵀH⁻¹B, and the gradient's part,
/// at its end of the chain, D − EᵀH⁻¹E and B − EᵀH⁻¹B at the next keyframe.
FATHOM_INLINE void eliminate(const ChainFront& front, const Four (&E)[3], EliminatedKeyframe& out,
                             Four (&end)[3], ChainFront& next, ChainSums& sums) {
  const double d0 = front.D[0][0];
  const double i0 = 1.0 / d0;
  out.l10 = front.D[0][1] * i0;
  out.l20 = front.D[0][2] * i0;
  const double d1 = front.D[1][1] - out.l10 * front.D[0][1];
  const double i1 = 1.0 / d1;
  const double below = front.D[1][2] - out.l10 * front.D[0][2];
  out.l21 = below * i1;
  const double d2 = front.D[2][2] - out.l20 * front.D[0][2] - out.l21 * below;
  const double i2 = 1.0 / d2;
  sums.negative_pivots += (d0 < 0.0 ? 1 : 0) + (d1 < 0.0 ? 1 : 0) + (d2 < 0.0 ? 1 : 0);
  sums.is_sound = sums.is_sound && std::isfinite(i0 + i1 + i2) && std::isfinite(d0 + d1 + d2);
  out.inverse[0] = i0;
  out.inverse[1] = i1;
  out.inverse[2] = i2;

  Four B[3] = {};
  Four Y[3] = {};
  B[0] = front.B[0];
  Y[0] = E[0];
  B[1] = front.B[1] - out.l10 * B[0];
  Y[1] = E[1] - out.l10 * Y[0];
  B[2] = front.B[2] - out.l20 * B[0] - out.l21 * B[1];
  Y[2] = E[2] - out.l20 * Y[0] - out.l21 * Y[1];
  for (int k = 0; k < 3; ++k) {
    const Four of_B = out.inverse[k] * B[k];
    const Four of_E = out.inverse[k] * Y[k];
    *reinterpret_cast<FourAnywhere*>(out.B[k]) = of_B;
    *reinterpret_cast<FourAnywhere*>(out.E[k]) = of_E;
    sums.decrease += B[k][3] * of_B[3];
    for (int a = 0; a < 3; ++a) {
      end[a] -= B[k][a] * of_B;
      next.B[a] -= Y[k][a] * of_B;
      next.D[a] -= Y[k][a] * of_E;
    }
  }
}

}  // namespace fathom::pose_graph
