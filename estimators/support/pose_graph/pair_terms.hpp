#pragma once

#include <array>

#include "estimators/support/pose_graph/edge.hpp"

namespace fathom::pose_graph {

/// The second derivatives to work with.
enum class Hessian {
  gauss_newton,  ///< Jᵀ W J
  measured,      ///< Jᵀ W J with the levers of the measured motions (Lever::measured)
  exact,         ///< all of them: Jᵀ W J + Σ (W ν)_r ∇² h_r
  positions      ///< Jᵀ W J of the positions; a step turns nothing
};

/// What an edge, or a chain of them, adds to F and to the matrix and gradient of ½F at its ends.
struct PairTerms {
  double cost = 0.0;
  std::array<double, 6> H_from{};  ///< xx xy xθ yy yθ θθ
  std::array<double, 6> H_to{};
  std::array<double, 9> H_cross{};  ///< by rows: rows of `from`, columns of `to`
  std::array<double, 3> g_from{};
  std::array<double, 3> g_to{};
};

/// Those of an edge: H_to = M, H_cross = −Tᵀ M, H_from = Tᵀ M T, g_to = m, g_from = −Tᵀ m
/// (EdgeTerms); with Hessian::exact the second derivatives of h as well
/// (docs/estimators/sparse_gauss_newton.md).
template <Hessian kHessian>
[[gnu::always_inline]] inline PairTerms pair_terms(const EdgeTerms& t) {
  const auto& M = t.M;
  const auto& m = t.m;
  // Row θ of Tᵀ M, and below element (θ, θ) of Tᵀ M T.
  const double rx = -t.dy * M[0] + t.dx * M[1] + M[2];
  const double ry = -t.dy * M[1] + t.dx * M[3] + M[4];
  const double rt = -t.dy * M[2] + t.dx * M[4] + M[5];
  PairTerms p;
  p.cost = t.cost;
  p.H_from = {M[0], M[1], rx, M[3], ry, -t.dy * rx + t.dx * ry + rt};
  p.H_to = M;
  p.H_cross = {-M[0], -M[1], -M[2], -M[1], -M[3], -M[4], -rx, -ry, -rt};
  p.g_from = {-m[0], -m[1], -(-t.dy * m[0] + t.dx * m[1] + m[2])};
  p.g_to = m;
  if constexpr (kHessian == Hessian::exact) {
    p.H_from[2] += m[1];
    p.H_from[4] -= m[0];
    p.H_from[5] -= m[0] * t.dx + m[1] * t.dy;
    p.H_cross[6] -= m[1];
    p.H_cross[7] += m[0];
  }
  if constexpr (kHessian == Hessian::positions) {
    p.H_from = p.H_to = {M[0], M[1], 0.0, M[3], 0.0, 1.0};
    p.H_cross = {-M[0], -M[1], 0.0, -M[1], -M[3], 0.0, 0.0, 0.0, 0.0};
    p.g_from[2] = p.g_to[2] = 0.0;
  }
  return p;
}

/// The same as seen from the other end.
[[gnu::always_inline]] inline PairTerms reversed(const PairTerms& t) {
  const auto& X = t.H_cross;
  return {t.cost, t.H_to,  t.H_from, {X[0], X[3], X[6], X[1], X[4], X[7], X[2], X[5], X[8]},
          t.g_to, t.g_from};
}

template <Hessian kHessian>
inline constexpr Lever kLeverOf =
    kHessian == Hessian::measured ? Lever::measured : Lever::estimated;

}  // namespace fathom::pose_graph
