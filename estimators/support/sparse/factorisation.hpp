#pragma once

#include <algorithm>
#include <cmath>

#include "estimators/support/sparse/dense_kernel.hpp"
#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::sparse {

/// The numeric factorisation L D Lᵀ of panels, in place: the work of BlockCholesky::factorise.
template <int B>
struct Factorisation {
  const Symbolic& symbolic;
  double* panels;
  double* signs;
  double* packed;
  int negative = 0;
  double* inverses = nullptr;  ///< 1 / the diagonal of L, for substitutions

  // Row block `row` of columns [0, depth) of a panel, times D, as the right side of a product.
  FATHOM_INLINE void pack(const double* panel, int stride, int row, int depth,
                          const double* sign) const {
    for (int k = 0; k < depth; ++k) {
      const double* from = panel + at(k) * at(stride) + at(row * B);
      for (int j = 0; j < B; ++j) packed[k * B + j] = sign[k] * from[j];
    }
  }

  // The B × B diagonal block in place: L below, the reciprocals of the pivots times D returned.
  FATHOM_INLINE bool factor_diagonal(double* block, int stride, double* sign, double* inverse) {
    for (int j = 0; j < B; ++j) {
      double pivot = block[j + j * stride];
      for (int p = 0; p < j; ++p) {
        pivot -= sign[p] * block[j + p * stride] * block[j + p * stride];
      }
      if (!(pivot > 0.0)) {
        if (!(pivot < 0.0)) return false;
        ++negative;
      }
      if (!std::isfinite(pivot)) return false;
      sign[j] = pivot > 0.0 ? 1.0 : -1.0;
      const double root = std::sqrt(std::abs(pivot));
      block[j + j * stride] = root;
      inverse[j] = sign[j] / root;
      for (int i = j + 1; i < B; ++i) {
        double sum = block[i + j * stride];
        for (int p = 0; p < j; ++p) {
          sum -= sign[p] * block[i + p * stride] * block[j + p * stride];
        }
        block[i + j * stride] = sum * inverse[j];
      }
    }
    return true;
  }

  // The rows below a diagonal block, a row of its B columns at a time.
  FATHOM_INLINE void solve_below(double* block, int stride, int count, const double* sign,
                                 const double* inverse) const {
    double L[B][B];
    for (int j = 0; j < B; ++j) {
      for (int p = 0; p < j; ++p) L[j][p] = sign[p] * block[j + p * stride];
    }
    double* const below = block + B;
#pragma GCC ivdep
    for (int i = 0; i < count; ++i) {
      double row[B];
      for (int j = 0; j < B; ++j) {
        row[j] = below[i + j * stride];
        for (int p = 0; p < j; ++p) row[j] -= L[j][p] * row[p];
        row[j] *= inverse[j];
        below[i + j * stride] = row[j];
      }
    }
  }

  FATHOM_INLINE bool factor_panel(const Supernode& s, double* panel, int stride, double* sign) {
    alignas(32) double out[kTileRows * B];
    const int all = s.panel_rows() * B;
    for (int column = 0; column < s.width; ++column) {
      double* top = panel + at(column * B) * at(stride);
      if (column > 0) {
        pack(panel, stride, column, column * B, sign);
        for (int row = column * B; row < all; row += kTileRows) {
          const int rows = std::min(kTileRows, all - row);
          multiply_rows<B>(rows, panel + row, stride, packed, column * B, out);
          for (int j = 0; j < B; ++j) {
            double* to = top + row + at(j * stride);
            for (int i = 0; i < rows; ++i) to[i] -= out[i + j * kTileRows];
          }
        }
      }
      double inverse[B];
      double* diagonal = top + at(column * B);
      double* own = sign + at(column * B);
      if (!factor_diagonal(diagonal, stride, own, inverse)) return false;
      solve_below(diagonal, stride, all - (column + 1) * B, own, inverse);
    }
    return true;
  }

  FATHOM_INLINE void subtract(const double* out, int blocks, const int* places, double* to,
                              int stride) const {
    for (int i = 0; i < blocks; ++i) {
      double* block = to + at(places[i] * B);
      for (int b = 0; b < B; ++b) {
        for (int a = 0; a < B; ++a) block[a + b * stride] -= out[i * B + a + b * kTileRows];
      }
    }
  }

  FATHOM_INLINE void update(const Supernode& s, const Update& u, const double* panel, int stride,
                            const double* sign) const {
    alignas(32) double out[kTileRows * B];
    constexpr int kTileBlocks = kTileRows / B;
    const Supernode& t = symbolic.supernodes[at(u.target)];
    const int t_stride = t.panel_rows() * B;
    double* target = panels + t.panel * kBlockNumbers<B>;
    const int* places = symbolic.places.data() + u.places - u.begin;
    for (int column = u.begin; column < u.end; ++column) {
      pack(panel, stride, s.width + column, s.width * B, sign);
      double* to = target + at(places[column] * B) * at(t_stride);
      for (int row = column; row < s.height; row += kTileBlocks) {
        const int blocks = std::min(kTileBlocks, s.height - row);
        multiply_rows<B>(blocks * B, panel + at((s.width + row) * B), stride, packed, s.width * B,
                         out);
        subtract(out, blocks, places + row, to, t_stride);
      }
    }
  }

  FATHOM_INLINE bool run() {
    for (const Supernode& s : symbolic.supernodes) {
      double* panel = panels + s.panel * kBlockNumbers<B>;
      const int stride = s.panel_rows() * B;
      double* sign = signs + at(s.first * B);
      if (!factor_panel(s, panel, stride, sign)) return false;
      for (int k = 0; k < s.width * B; ++k) {
        inverses[at(s.first * B + k)] = 1.0 / panel[at(k) * at(stride) + at(k)];
      }
      for (int u = s.updates; u < s.updates + s.update_count; ++u) {
        update(s, symbolic.updates[at(u)], panel, stride, sign);
      }
    }
    return true;
  }
};

}  // namespace fathom::sparse
