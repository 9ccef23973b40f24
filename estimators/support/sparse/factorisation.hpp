#pragma once

#include <algorithm>
#include <cmath>

#include "estimators/support/sparse/substitution.hpp"

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
  Inertia inertia = Inertia::any;
  const Substitution<B>* forward =
      nullptr;  ///< of a right side, as long as a panel is in the cache

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

  // Rows below a diagonal block, a row of its B columns at a time.
  FATHOM_INLINE void solve_rows(const double* block, double* rows, int stride, int count,
                                const double* sign, const double* inverse) const {
    double L[B][B];
    for (int j = 0; j < B; ++j) {
      for (int p = 0; p < j; ++p) L[j][p] = sign[p] * block[j + p * stride];
    }
#ifndef __clang__
#pragma GCC ivdep
#endif
    for (int i = 0; i < count; ++i) {
      double row[B];
      for (int j = 0; j < B; ++j) {
        row[j] = rows[i + j * stride];
        for (int p = 0; p < j; ++p) row[j] -= L[j][p] * row[p];
        row[j] *= inverse[j];
        rows[i + j * stride] = row[j];
      }
    }
  }

  // Subtracts the products of the block columns before `column`, of scalar rows [begin, end).
  FATHOM_INLINE void subtract_before(double* panel, int stride, int column, int begin, int end,
                                     const double* sign) const {
    if (column == 0) return;
    alignas(32) double out[kTileRows * B];
    double* top = panel + at(column * B) * at(stride);
    pack(panel, stride, column, column * B, sign);
    for (int row = begin; row < end; row += kTileRows) {
      const int rows = std::min(kTileRows, end - row);
      multiply_rows<B>(rows, panel + row, stride, packed, column * B, out);
      for (int j = 0; j < B; ++j) {
        double* to = top + row + at(j * stride);
        for (int i = 0; i < rows; ++i) to[i] -= out[i + j * kTileRows];
      }
    }
  }

  // The first `rows` scalar rows, the diagonal block among them.
  FATHOM_INLINE bool factor_panel(const Supernode& s, double* panel, int stride, int rows,
                                  double* sign) {
    for (int column = 0; column < s.width; ++column) {
      subtract_before(panel, stride, column, column * B, rows, sign);
      double inverse[B];
      double* diagonal = panel + at(column * B) * at(stride) + at(column * B);
      double* own = sign + at(column * B);
      if (!factor_diagonal(diagonal, stride, own, inverse)) return false;
      solve_rows(diagonal, diagonal + B, stride, rows - (column + 1) * B, own, inverse);
    }
    return true;
  }

  FATHOM_INLINE void invert_diagonal(const Supernode& s, const double* panel, int stride) const {
    for (int k = 0; k < s.width * B; ++k) {
      inverses[at(s.first * B + k)] = 1.0 / panel[at(k) * at(stride) + at(k)];
    }
  }

  // Scalar rows [begin, end) below the diagonal block, which is done.
  FATHOM_INLINE void factor_below(const Supernode& s, double* panel, int stride, int begin, int end,
                                  const double* sign) const {
    for (int column = 0; column < s.width; ++column) {
      subtract_before(panel, stride, column, begin, end, sign);
      double* top = panel + at(column * B) * at(stride);
      const double* diagonal = top + at(column * B);
      const double* own = sign + at(column * B);
      double inverse[B];
      for (int j = 0; j < B; ++j) inverse[j] = own[j] / diagonal[j + j * stride];
      solve_rows(diagonal, top + begin, stride, end - begin, own, inverse);
    }
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

  // update() of a narrow supernode, the same numbers.
  FATHOM_INLINE void update_narrow(const Update& u, const double* panel, int stride,
                                   const double* sign, int first, int last) const {
    const Supernode& t = symbolic.supernodes[at(u.target)];
    const int t_stride = t.panel_rows() * B;
    double* target = panels + t.panel * kBlockNumbers<B>;
    const int* places = symbolic.places.data() + u.places - u.begin;
    for (int column = u.begin; column < std::min(u.end, last); ++column) {
      double right[B][B];
      for (int k = 0; k < B; ++k) {
        const double* from = panel + at((column + 1) * B + k * stride);
        for (int b = 0; b < B; ++b) right[k][b] = sign[k] * from[b];
      }
      double* to = target + at(places[column] * B) * at(t_stride);
      for (int row = std::max(column, first); row < last; ++row) {
        const double* left = panel + at((row + 1) * B);
        double* block = to + at(places[row] * B);
        for (int b = 0; b < B; ++b) {
          for (int a = 0; a < B; ++a) {
            double sum = left[a] * right[0][b];
            for (int k = 1; k < B; ++k) sum += left[a + k * stride] * right[k][b];
            block[a + b * t_stride] -= sum;
          }
        }
      }
    }
  }

  // Of the source's rows below, those of [first, last).
  FATHOM_INLINE void update(const Supernode& s, const Update& u, const double* panel, int stride,
                            const double* sign, int first, int last) const {
    if (is_narrow<B>(s)) return update_narrow(u, panel, stride, sign, first, last);
    alignas(32) double out[kTileRows * B];
    constexpr int kTileBlocks = kTileRows / B;
    const Supernode& t = symbolic.supernodes[at(u.target)];
    const int t_stride = t.panel_rows() * B;
    double* target = panels + t.panel * kBlockNumbers<B>;
    const int* places = symbolic.places.data() + u.places - u.begin;
    for (int column = u.begin; column < std::min(u.end, last); ++column) {
      pack(panel, stride, s.width + column, s.width * B, sign);
      double* to = target + at(places[column] * B) * at(t_stride);
      for (int row = std::max(column, first); row < last; row += kTileBlocks) {
        const int blocks = std::min(kTileBlocks, last - row);
        multiply_rows<B>(blocks * B, panel + at((s.width + row) * B), stride, packed, s.width * B,
                         out);
        subtract(out, blocks, places + row, to, t_stride);
      }
    }
  }

  // Supernodes [begin, end), one after the other; updates of supernodes from `end` on are left.
  FATHOM_INLINE bool run(int begin, int end) {
    for (int i = begin; i < end; ++i) {
      const Supernode& s = symbolic.supernodes[at(i)];
      double* panel = panels + s.panel * kBlockNumbers<B>;
      const int stride = s.panel_rows() * B;
      double* sign = signs + at(s.first * B);
      if (!factor_panel(s, panel, stride, stride, sign)) return false;
      if (negative > 0 && inertia == Inertia::positive) return false;
      invert_diagonal(s, panel, stride);
      if (forward != nullptr) forward->forward(s);
      for (int j = s.updates; j < s.updates + s.update_count; ++j) {
        const Update& u = symbolic.updates[at(j)];
        if (u.target >= end) break;
        update(s, u, panel, stride, sign, 0, s.height);
      }
    }
    return true;
  }

  FATHOM_INLINE bool run() {
    return run(0, static_cast<int>(symbolic.supernodes.size()));
  }
};

}  // namespace fathom::sparse
