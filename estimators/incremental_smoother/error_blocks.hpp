#pragma once

#include "estimators/incremental_smoother/local_edge.hpp"

namespace fathom::incremental_smoother {

/// The Gauss-Newton blocks, by rows, of an edge whose pictures' errors are unknowns: ν = h − z +
/// G_from n_from + G_to n_to, so with the Jacobians −T, Q of EdgeBlocks those of n are G. Of an end
/// that has none they are zero.
struct ErrorBlocks {
  using Block = std::array<double, 9>;
  struct End {
    Block with_from{};  ///< −Gᵀ W T
    Block with_to{};    ///< Gᵀ W Q
    Block own{};        ///< Gᵀ W G
  };
  End from;
  End to;
  Block between{};  ///< G_toᵀ W G_from

  void scale(double factor) {
    for (Block* block : {&from.with_from, &from.with_to, &from.own, &to.with_from, &to.with_to,
                         &to.own, &between}) {
      for (double& element : *block) element *= factor;
    }
  }
};

/// Gᵀ M, M by rows.
inline ErrorBlocks::Block transposed_times(const Eigen::Matrix3d& G, const ErrorBlocks::Block& M) {
  const double* g = G.data();
  ErrorBlocks::Block product;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      product[3 * i + j] = g[3 * i] * M[j] + g[3 * i + 1] * M[3 + j] + g[3 * i + 2] * M[6 + j];
    }
  }
  return product;
}

/// W G, by rows.
inline ErrorBlocks::Block weighted(const std::array<double, 6>& W, const Eigen::Matrix3d& G) {
  ErrorBlocks::Block product;
  for (std::size_t j = 0; j < 3; ++j) {
    const double* g = G.data() + 3 * j;
    product[j] = W[0] * g[0] + W[1] * g[1] + W[2] * g[2];
    product[3 + j] = W[1] * g[0] + W[3] * g[1] + W[4] * g[2];
    product[6 + j] = W[2] * g[0] + W[4] * g[1] + W[5] * g[2];
  }
  return product;
}

inline ErrorBlocks error_blocks_of(const Edge& edge, const Node& i, const Node& k) {
  const auto& W = edge.W;
  const double dx = k.x - i.x;
  const double dy = k.y - i.y;
  const double hx = i.c * dx + i.s * dy;
  const double hy = -i.s * dx + i.c * dy;
  const double c = i.c * k.c + i.s * k.s;
  const double s = i.c * k.s - i.s * k.c;
  const ErrorBlocks::Block by_from{-W[0], -W[1], hy * W[0] - hx * W[1] - W[2],
                                   -W[1], -W[3], hy * W[1] - hx * W[3] - W[4],
                                   -W[2], -W[4], hy * W[2] - hx * W[4] - W[5]};
  const ErrorBlocks::Block by_to{c * W[0] + s * W[1], -s * W[0] + c * W[1], W[2],
                                 c * W[1] + s * W[3], -s * W[1] + c * W[3], W[4],
                                 c * W[2] + s * W[4], -s * W[2] + c * W[4], W[5]};
  ErrorBlocks b;
  const auto fill = [&](const pose_graph::SharedEnds::End& end, ErrorBlocks::End& blocks) {
    if (end.node < 0) return;
    blocks.with_from = transposed_times(end.G, by_from);
    blocks.with_to = transposed_times(end.G, by_to);
    blocks.own = transposed_times(end.G, weighted(W, end.G));
  };
  fill(edge.shared->from, b.from);
  fill(edge.shared->to, b.to);
  if (edge.shared->from.node >= 0 && edge.shared->to.node >= 0) {
    b.between = transposed_times(edge.shared->to.G, weighted(W, edge.shared->from.G));
  }
  return b;
}

}  // namespace fathom::incremental_smoother
