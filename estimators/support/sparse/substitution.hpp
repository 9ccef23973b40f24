#pragma once

#include "estimators/support/sparse/dense_kernel.hpp"
#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::sparse {

/// Forward and backward substitution with the panels of L D Lᵀ: the work of BlockCholesky::solve.
/// By block columns, so that each number of the right side is fetched once for B columns.
template <int B>
struct Substitution {
  const Symbolic& symbolic;
  const double* panels;
  const double* signs;     ///< null: all are 1
  const double* inverses;  ///< 1 / the diagonal of L
  double* x;
  double* gathered;
  bool is_forward_done = false;

  // L y = x for the diagonal block, in place.
  FATHOM_INLINE void solve_diagonal(const double* block, int stride, const double* inverse,
                                    double* y) const {
    for (int b = 0; b < B; ++b) {
      y[b] *= inverse[b];
      for (int i = b + 1; i < B; ++i) y[i] -= block[i + b * stride] * y[b];
    }
  }

  // solve_own of a narrow one.
  FATHOM_INLINE void solve_narrow(const Supernode& s, double* products) const {
    const double* panel = panels + s.panel * kBlockNumbers<B>;
    const int stride = s.panel_rows() * B;
    double* own = x + at(s.first * B);
    solve_diagonal(panel, stride, inverses + at(s.first * B), own);
    for (int i = 0; i < s.height; ++i) {
      const double* block = panel + at((i + 1) * B);
      for (int a = 0; a < B; ++a) {
        double sum = block[a] * own[0];
        for (int b = 1; b < B; ++b) sum += block[a + b * stride] * own[b];
        products[i * B + a] = sum;
      }
    }
  }

  // Leaves in `products` what is to be subtracted from the rows below.
  FATHOM_INLINE void solve_own(const Supernode& s, double* products) const {
    if (is_narrow<B>(s)) return solve_narrow(s, products);
    const double* panel = panels + s.panel * kBlockNumbers<B>;
    const int stride = s.panel_rows() * B;
    const double* inverse = inverses + at(s.first * B);
    double* own = x + at(s.first * B);
    const int width = s.width * B;
    const int height = s.height * B;
    for (int k = 0; k < width; k += B) {
      const double* columns = panel + at(k) * at(stride);
      solve_diagonal(columns + k, stride, inverse + k, own + k);
      double y[B];
      for (int b = 0; b < B; ++b) y[b] = own[k + b];
      const auto product = [&](int i) {
        double sum = columns[i] * y[0];
        for (int b = 1; b < B; ++b) sum += columns[i + b * stride] * y[b];
        return sum;
      };
      for (int i = k + B; i < width; ++i) own[i] -= product(i);
      if (k == 0) {
        for (int i = 0; i < height; ++i) products[i] = product(width + i);
      } else {
        for (int i = 0; i < height; ++i) products[i] += product(width + i);
      }
    }
  }

  // From the rows [first, last) below; the products begin with those of `first`.
  FATHOM_INLINE void subtract(const Supernode& s, const double* products, int first,
                              int last) const {
    const int* rows = symbolic.rows.data() + s.rows + first;
    for (int i = 0; i < last - first; ++i) {
      for (int a = 0; a < B; ++a) x[rows[i] * B + a] -= products[i * B + a];
    }
  }

  // The same numbers as of a wider one, without its loops.
  FATHOM_INLINE void backward_narrow(const Supernode& s) const {
    const double* panel = panels + s.panel * kBlockNumbers<B>;
    const int stride = s.panel_rows() * B;
    const double* inverse = inverses + at(s.first * B);
    double* own = x + at(s.first * B);
    const int* rows = symbolic.rows.data() + s.rows;
    double sum[B][B] = {};
    for (int i = 0; i < s.height; ++i) {
      const double* block = panel + at((i + 1) * B);
      const double* right = x + at(rows[i] * B);
      for (int b = 0; b < B; ++b) {
        for (int a = 0; a < B; ++a) sum[b][a] += block[a + b * stride] * right[a];
      }
    }
    for (int b = B - 1; b >= 0; --b) {
      double value = own[b];
      for (int a = 0; a < B; ++a) value -= sum[b][a];
      for (int i = b + 1; i < B; ++i) value -= panel[i + b * stride] * own[i];
      own[b] = value * inverse[b];
    }
  }

  FATHOM_INLINE void forward(const Supernode& s) const {
    solve_own(s, gathered);
    subtract(s, gathered, 0, s.height);
  }

  FATHOM_INLINE void backward(const Supernode& s) const {
    if (is_narrow<B>(s)) return backward_narrow(s);
    const double* panel = panels + s.panel * kBlockNumbers<B>;
    const int stride = s.panel_rows() * B;
    const int* rows = symbolic.rows.data() + s.rows;
    const double* inverse = inverses + at(s.first * B);
    double* own = x + at(s.first * B);
    const int width = s.width * B;
    const int height = s.height * B;
    for (int i = 0; i < s.height; ++i) {
      for (int a = 0; a < B; ++a) gathered[i * B + a] = x[rows[i] * B + a];
    }
    for (int k = width - B; k >= 0; k -= B) {
      const double* columns = panel + at(k) * at(stride);
      // Sums of every B-th row each: one alone waits for itself.
      double sum[B][B] = {};
      const auto add = [&](const double* from, const double* right, int count) {
        for (int i = 0; i < count; i += B) {
          for (int b = 0; b < B; ++b) {
            for (int a = 0; a < B; ++a) sum[b][a] += from[i + a + b * stride] * right[i + a];
          }
        }
      };
      add(columns + k + B, own + k + B, width - k - B);
      add(columns + width, gathered, height);
      const double* block = columns + k;
      for (int b = B - 1; b >= 0; --b) {
        double value = own[k + b];
        for (int a = 0; a < B; ++a) value -= sum[b][a];
        for (int i = b + 1; i < B; ++i) value -= block[i + b * stride] * own[k + i];
        own[k + b] = value * inverse[k + b];
      }
    }
  }

  FATHOM_INLINE void apply_signs() const {
    for (int i = 0; signs != nullptr && i < symbolic.size() * B; ++i) x[i] *= signs[i];
  }

  FATHOM_INLINE bool run() {
    const std::vector<Supernode>& all = symbolic.supernodes;
    for (std::size_t i = 0; !is_forward_done && i < all.size(); ++i) forward(all[i]);
    apply_signs();
    for (std::size_t i = all.size(); i > 0; --i) backward(all[i - 1]);
    return true;
  }
};

}  // namespace fathom::sparse
