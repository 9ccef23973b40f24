#pragma once

#include <array>

#include "estimators/support/pose_graph/edge.hpp"

namespace fathom::incremental_smoother {

using pose_graph::Edge;
using pose_graph::make_node;
using pose_graph::Node;

/// A correction of a keyframe along its own axes (metres, metres, radians), or what is dual to it.
using Vec3 = std::array<double, 3>;

/// ½F of one edge and its gradient, each keyframe's along its own axes.
struct EdgeGradient {
  double cost = 0.0;  ///< νᵀ W ν
  Vec3 from{};
  Vec3 to{};
};

/// The Gauss-Newton blocks of one edge in those axes, by rows. With h the motion as it is
/// estimated, T = [1 0 −h_y; 0 1 h_x; 0 0 1] and Q = diag(Rot(h_θ), 1) the Jacobians are −T and Q:
/// they depend on h alone, so a part of the map that moves as one keeps its blocks.
struct EdgeBlocks {
  std::array<double, 9> from_from{};
  std::array<double, 9> to_from{};
  std::array<double, 9> to_to{};

  void scale(double factor) {
    for (auto* block : {&from_from, &to_from, &to_to}) {
      for (double& element : *block) element *= factor;
    }
  }
};

inline EdgeGradient gradient_of(const Edge& edge, const Node& i, const Node& k) {
  const auto& W = edge.W;
  const double dx = k.x - i.x;
  const double dy = k.y - i.y;
  const double hx = i.c * dx + i.s * dy;
  const double hy = -i.s * dx + i.c * dy;
  const double nx = hx - edge.x;
  const double ny = hy - edge.y;
  const double nt = wrap_angle(k.theta - i.theta - edge.theta);
  const double wx = W[0] * nx + W[1] * ny + W[2] * nt;
  const double wy = W[1] * nx + W[3] * ny + W[4] * nt;
  const double wt = W[2] * nx + W[4] * ny + W[5] * nt;
  const double c = i.c * k.c + i.s * k.s;
  const double s = i.c * k.s - i.s * k.c;
  return {nx * wx + ny * wy + nt * wt,
          {-wx, -wy, hy * wx - hx * wy - wt},
          {c * wx + s * wy, -s * wx + c * wy, wt}};
}

inline EdgeBlocks blocks_of(const Edge& edge, const Node& i, const Node& k) {
  const auto& W = edge.W;
  const double dx = k.x - i.x;
  const double dy = k.y - i.y;
  const double hx = i.c * dx + i.s * dy;
  const double hy = -i.s * dx + i.c * dy;
  const double c = i.c * k.c + i.s * k.s;
  const double s = i.c * k.s - i.s * k.c;
  // W T, by rows.
  const double a02 = -hy * W[0] + hx * W[1] + W[2];
  const double a12 = -hy * W[1] + hx * W[3] + W[4];
  const double a22 = -hy * W[2] + hx * W[4] + W[5];
  EdgeBlocks b;
  b.from_from = {W[0], W[1], a02, W[1], W[3], a12, a02, a12, -hy * a02 + hx * a12 + a22};
  // −Qᵀ W T.
  b.to_from = {-(c * W[0] + s * W[1]),
               -(c * W[1] + s * W[3]),
               -(c * a02 + s * a12),
               s * W[0] - c * W[1],
               s * W[1] - c * W[3],
               s * a02 - c * a12,
               -W[2],
               -W[4],
               -a22};
  const double xx = c * c * W[0] + 2.0 * c * s * W[1] + s * s * W[3];
  const double xy = c * s * (W[3] - W[0]) + (c * c - s * s) * W[1];
  const double yy = s * s * W[0] - 2.0 * c * s * W[1] + c * c * W[3];
  const double xt = c * W[2] + s * W[4];
  const double yt = -s * W[2] + c * W[4];
  b.to_to = {xx, xy, xt, xy, yy, yt, xt, yt, W[5]};
  return b;
}

}  // namespace fathom::incremental_smoother
