#pragma once

#include <algorithm>
#include <cmath>
#include <span>

#include "estimators/incremental_smoother/clique.hpp"
#include "estimators/incremental_smoother/error_blocks.hpp"
#include "estimators/incremental_smoother/motion.hpp"
#include "estimators/incremental_smoother/problem.hpp"
#include "estimators/support/sparse/factorisation.hpp"

namespace fathom::incremental_smoother {

using sparse::kReadAhead;
using sparse::kTileRows;

inline constexpr int B = 3;

/// Adds up and factors cliques, children before parents: the multifrontal method (Duff and Reid
/// 1983). Each takes its edges and the updates of its children.
struct FrontFactorisation {
  const Problem& problem;
  LoopWeights& loops;
  std::vector<Clique>& cliques;
  std::span<const int> which;
  VariablePointer<const long> order;  ///< of elimination
  VariablePointer<int> row_of;        ///< of the clique at hand
  double* packed;
  double* signs;

  // Block (row, column) += b, by rows; in either triangle.
  FATHOM_INLINE static void add_block(Clique& c, int row, int column, const double* b) {
    int down = 1;
    int along = 0;
    double* to = place(c, std::max(row, column), std::min(row, column), along);
    if (row < column) std::swap(down, along);
    for (int i = 0; i < B; ++i) {
      for (int j = 0; j < B; ++j) to[i * down + j * along] += b[B * i + j];
    }
  }

  FATHOM_INLINE static double* place(Clique& c, int row, int column, int& stride) {
    if (column < c.width) {
      stride = c.rows() * B;
      return c.panel.data() + at(column * B) * at(stride) + at(row * B);
    }
    const int j = column - c.width;
    stride = (c.height - j) * B;
    return c.update.data() + c.update_column(j) + at((row - column) * B);
  }

  FATHOM_INLINE void add_edges(Clique& c) const {
    for (int j = 0; j < c.width; ++j) {
      const int v = c.variables[at(j)];
      if (is_errors(v)) add_prior(c, j);
      problem.for_each_edge_of(v, [&](int e, int other) {
        // Eliminated before, and so in a child's update.
        if (order[other] < order[v]) return;
        const Edge& edge = problem.edges[at(e)];
        if (edge.shared != nullptr && !is_eliminated_first(v, edge)) return;
        EdgeBlocks b = blocks_of(edge, problem.nodes[at(edge.from)], problem.nodes[at(edge.to)]);
        if (loops.has(e)) b.scale(loops.factor(e));
        const int from = row_of[edge.from];
        const int to = row_of[edge.to];
        add_block(c, from, from, b.from_from.data());
        add_block(c, to, to, b.to_to.data());
        add_block(c, to, from, b.to_from.data());
        if (edge.shared != nullptr) add_errors(c, e, edge);
      });
    }
  }

  FATHOM_INLINE bool is_eliminated_first(int v, const Edge& edge) const {
    bool is_first = true;
    problem.for_each_errors(edge, [&](int n) { is_first = is_first && order[v] <= order[n]; });
    return is_first;
  }

  FATHOM_INLINE static void add_prior(Clique& c, int column) {
    int stride = 0;
    double* to = place(c, column, column, stride);
    for (int i = 0; i < B; ++i) to[i + i * stride] += 1.0;
  }

  FATHOM_INLINE void add_errors(Clique& c, int e, const Edge& edge) const {
    ErrorBlocks b = error_blocks_of(edge, problem.nodes[at(edge.from)], problem.nodes[at(edge.to)]);
    if (loops.has(e)) b.scale(loops.factor(e));
    const bool has_from = edge.shared->from.node >= 0;
    const bool has_to = edge.shared->to.node >= 0;
    const auto add_end = [&](const ErrorBlocks::End& end, int keyframe) {
      const int row = row_of[errors_of(keyframe)];
      add_block(c, row, row_of[edge.from], end.with_from.data());
      add_block(c, row, row_of[edge.to], end.with_to.data());
      add_block(c, row, row, end.own.data());
    };
    if (has_from) add_end(b.from, edge.from);
    if (has_to) add_end(b.to, edge.to);
    if (!has_from || !has_to) return;
    add_block(c, row_of[errors_of(edge.to)], row_of[errors_of(edge.from)], b.between.data());
  }

  FATHOM_INLINE void add_child(Clique& c, const Clique& child) const {
    for (int j = 0; j < child.height; ++j) {
      const int stride = (child.height - j) * B;
      const double* below = child.update.data() + child.update_column(j);
      const int column = row_of[child.variables[at(child.width + j)]];
      for (int i = j; i < child.height; ++i) {
        const int row = row_of[child.variables[at(child.width + i)]];
        const double* from = below + at((i - j) * B);
        int along = 0;
        if (row >= column) {
          double* to = place(c, row, column, along);
          for (int b = 0; b < B; ++b) {
            for (int a = 0; a < B; ++a) to[a + b * along] += from[a + b * stride];
          }
        } else {
          double* to = place(c, column, row, along);
          for (int b = 0; b < B; ++b) {
            for (int a = 0; a < B; ++a) to[b + a * along] += from[a + b * stride];
          }
        }
      }
    }
  }

  // update −= L₂₁ L₂₁ᵀ, on and below the diagonal.
  FATHOM_INLINE void complement(Clique& c) const {
    alignas(32) double out[kTileRows * B];
    const int stride = c.rows() * B;
    const int depth = c.width * B;
    const int height = c.height * B;
    const double* below = c.panel.data() + depth;
    for (int column = 0; column < height; column += B) {
      for (int k = 0; k < depth; ++k) {
        for (int j = 0; j < B; ++j) packed[k * B + j] = below[at(k) * at(stride) + at(column + j)];
      }
      double* to = c.update.data() + c.update_column(column / B);
      const int to_stride = height - column;
      for (int row = column; row < height; row += kTileRows) {
        const int rows = std::min(kTileRows, height - row);
        sparse::multiply_rows<B>(rows, below + row, stride, packed, depth, out);
        for (int j = 0; j < B; ++j) {
          for (int i = 0; i < rows; ++i) {
            to[row - column + i + j * to_stride] -= out[i + j * kTileRows];
          }
        }
      }
    }
  }

  FATHOM_INLINE bool factor(Clique& c) const {
    const Node& seen_from = problem.nodes[at(c.variables.back())];
    for (int i = 0; i < c.rows(); ++i) {
      const int v = c.variables[at(i)];
      row_of[v] = i;
      if (is_errors(v)) continue;
      offset_of(seen_from, problem.nodes[at(v)], c.layout.data() + 3 * at(i));
    }
    add_edges(c);
    for (const int child : c.children) add_child(c, cliques[at(child)]);
    static const sparse::Symbolic kNone;
    sparse::Factorisation<B> dense{kNone, nullptr, nullptr, packed};
    sparse::Supernode shape;
    shape.width = c.width;
    shape.height = c.height;
    const int stride = c.rows() * B;
    if (!dense.factor_panel(shape, c.panel.data(), stride, stride, signs)) return false;
    if (dense.negative > 0) return false;
    complement(c);
    return true;
  }

  FATHOM_INLINE bool run() {
    for (const int i : which) {
      if (!factor(cliques[at(i)])) return false;
    }
    return true;
  }
};

/// y = L⁻¹ b in the columns of these cliques, children before parents.
struct ForwardSubstitution {
  const std::vector<Clique>& cliques;
  std::span<const int> which;
  VariablePointer<Vec3> x;
  double* gathered;

  FATHOM_INLINE void forward(const Clique& c) const {
    const int stride = c.rows() * B;
    const int width = c.width * B;
    for (int i = 0; i < stride; ++i) gathered[i] = 0.0;
    for (int i = 0; i < c.width; ++i) {
      const double* from = x[c.variables[at(i)]].data();
      for (int a = 0; a < B; ++a) gathered[i * B + a] = from[a];
    }
    for (int k = 0; k < width; ++k) {
      const double* column = c.panel.data() + at(k) * at(stride);
      const double value = gathered[k] /= column[k];
      for (int i = k + 1; i < stride; ++i) gathered[i] -= column[i] * value;
    }
    for (int i = 0; i < c.width; ++i) {
      double* to = x[c.variables[at(i)]].data();
      for (int a = 0; a < B; ++a) to[a] = gathered[i * B + a];
    }
    for (int i = c.width; i < c.rows(); ++i) {
      double* to = x[c.variables[at(i)]].data();
      for (int a = 0; a < B; ++a) to[a] += gathered[i * B + a];
    }
  }

  FATHOM_INLINE bool run() const {
    for (const int i : which) forward(cliques[at(i)]);
    return true;
  }
};

/// The step of one clique from its y and the step of its separator, in place.
struct BackwardSubstitution {
  const Clique& c;
  double* x;  ///< 3 numbers a row of the clique

  FATHOM_INLINE bool run() const {
    const int stride = c.rows() * B;
    for (int k = c.width * B - 1; k >= 0; --k) {
      const double* column = c.panel.data() + at(k) * at(stride);
      // Four sums: one alone waits for itself.
      double sum[4] = {x[k], 0.0, 0.0, 0.0};
      int i = k + 1;
      for (; i + 4 <= stride; i += 4) {
        for (int v = 0; v < 4; ++v) sum[v] -= column[i + v] * x[i + v];
      }
      for (; i < stride; ++i) sum[0] -= column[i] * x[i];
      x[k] = (sum[0] + sum[1] + (sum[2] + sum[3])) / column[k];
    }
    return true;
  }
};

}  // namespace fathom::incremental_smoother
