#pragma once

#include "estimators/support/sparse/dense_kernel.hpp"
#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::sparse {

/// Forward and backward substitution with the panels of L D Lᵀ: the work of BlockCholesky::solve.
template <int B>
struct Substitution {
  const Symbolic& symbolic;
  const double* panels;
  const double* signs;
  double* x;
  double* gathered;

  FATHOM_INLINE void forward(const Supernode& s) const {
    const double* panel = panels + s.panel * kBlockNumbers<B>;
    const int stride = s.panel_rows() * B;
    const int* rows = symbolic.rows.data() + s.rows;
    double* own = x + at(s.first * B);
    const int width = s.width * B;
    const int height = s.height * B;
    for (int i = 0; i < height; ++i) gathered[i] = 0.0;
    for (int k = 0; k < width; ++k) {
      const double* column = panel + at(k) * at(stride);
      const double value = own[k] /= column[k];
      for (int i = k + 1; i < width; ++i) own[i] -= column[i] * value;
      for (int i = 0; i < height; ++i) gathered[i] += column[width + i] * value;
    }
    for (int i = 0; i < s.height; ++i) {
      for (int a = 0; a < B; ++a) x[rows[i] * B + a] -= gathered[i * B + a];
    }
  }

  FATHOM_INLINE void backward(const Supernode& s) const {
    const double* panel = panels + s.panel * kBlockNumbers<B>;
    const int stride = s.panel_rows() * B;
    const int* rows = symbolic.rows.data() + s.rows;
    double* own = x + at(s.first * B);
    const int width = s.width * B;
    const int height = s.height * B;
    for (int i = 0; i < s.height; ++i) {
      for (int a = 0; a < B; ++a) gathered[i * B + a] = x[rows[i] * B + a];
    }
    for (int k = width - 1; k >= 0; --k) {
      const double* column = panel + at(k) * at(stride);
      // Four sums: one alone waits for itself.
      double sum[4] = {own[k], 0.0, 0.0, 0.0};
      for (int i = k + 1; i < width; ++i) sum[i % 4] -= column[i] * own[i];
      int i = 0;
      for (; i + 4 <= height; i += 4) {
        for (int v = 0; v < 4; ++v) sum[v] -= column[width + i + v] * gathered[i + v];
      }
      for (; i < height; ++i) sum[0] -= column[width + i] * gathered[i];
      own[k] = (sum[0] + sum[1] + (sum[2] + sum[3])) / column[k];
    }
  }

  FATHOM_INLINE bool run() {
    const std::vector<Supernode>& all = symbolic.supernodes;
    for (std::size_t i = 0; i < all.size(); ++i) forward(all[i]);
    for (int i = 0; i < symbolic.size() * B; ++i) x[i] *= signs[i];
    for (std::size_t i = all.size(); i > 0; --i) backward(all[i - 1]);
    return true;
  }
};

}  // namespace fathom::sparse
