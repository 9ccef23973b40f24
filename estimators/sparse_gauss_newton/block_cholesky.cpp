#include "estimators/sparse_gauss_newton/block_cholesky.hpp"

#include <algorithm>
#include <cmath>

#include "estimators/sparse_gauss_newton/dense_kernel.hpp"

namespace fathom::sparse_gauss_newton {
namespace {

std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

template <int B>
struct Factorisation {
  const Symbolic& symbolic;
  double* panels;
  double* signs;
  double* packed;
  int negative = 0;

  // Row block `row` of columns [0, depth) of a panel, times D, as the right side of a product.
  FATHOM_INLINE void pack(const double* panel, int stride, int row, int depth,
                          const double* sign) const {
    for (int k = 0; k < depth; ++k) {
      const double* from = panel + at(k) * at(stride) + row * B;
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

  FATHOM_INLINE void solve_below(double* block, int stride, int count, const double* sign,
                                 const double* inverse) const {
    for (int j = 0; j < B; ++j) {
      double* column = block + B + j * stride;
      for (int p = 0; p < j; ++p) {
        const double* left = block + B + p * stride;
        const double factor = sign[p] * block[j + p * stride];
        for (int i = 0; i < count; ++i) column[i] -= factor * left[i];
      }
      for (int i = 0; i < count; ++i) column[i] *= inverse[j];
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
            double* to = top + row + j * stride;
            for (int i = 0; i < rows; ++i) to[i] -= out[i + j * kTileRows];
          }
        }
      }
      double inverse[B];
      double* diagonal = top + column * B;
      if (!factor_diagonal(diagonal, stride, sign + column * B, inverse)) return false;
      solve_below(diagonal, stride, all - (column + 1) * B, sign + column * B, inverse);
    }
    return true;
  }

  FATHOM_INLINE void subtract(const double* out, int blocks, const int* places, double* to,
                              int stride) const {
    for (int i = 0; i < blocks; ++i) {
      double* block = to + places[i] * B;
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
    double* target = panels + t.panel * (B * B);
    const int* places = symbolic.places.data() + u.places - u.begin;
    for (int column = u.begin; column < u.end; ++column) {
      pack(panel, stride, s.width + column, s.width * B, sign);
      double* to = target + at(places[column] * B) * at(t_stride);
      for (int row = column; row < s.height; row += kTileBlocks) {
        const int blocks = std::min(kTileBlocks, s.height - row);
        multiply_rows<B>(blocks * B, panel + (s.width + row) * B, stride, packed, s.width * B, out);
        subtract(out, blocks, places + row, to, t_stride);
      }
    }
  }

  FATHOM_INLINE bool run() {
    for (const Supernode& s : symbolic.supernodes) {
      double* panel = panels + s.panel * (B * B);
      const int stride = s.panel_rows() * B;
      double* sign = signs + s.first * B;
      if (!factor_panel(s, panel, stride, sign)) return false;
      for (int u = s.updates; u < s.updates + s.update_count; ++u) {
        update(s, symbolic.updates[at(u)], panel, stride, sign);
      }
    }
    return true;
  }
};

template <int B>
struct Substitution {
  const Symbolic& symbolic;
  const double* panels;
  const double* signs;
  double* x;
  double* gathered;

  FATHOM_INLINE void forward(const Supernode& s) const {
    const double* panel = panels + s.panel * (B * B);
    const int stride = s.panel_rows() * B;
    const int* rows = symbolic.rows.data() + s.rows;
    double* own = x + s.first * B;
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
    const double* panel = panels + s.panel * (B * B);
    const int stride = s.panel_rows() * B;
    const int* rows = symbolic.rows.data() + s.rows;
    double* own = x + s.first * B;
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

}  // namespace

template <int B>
BlockCholesky<B>::BlockCholesky(const Symbolic& symbolic)
    : symbolic_(&symbolic), signs_(at(symbolic.size()) * B, 1.0) {
  panels_.resize(symbolic.panel_blocks * (B * B) + kReadAhead);
  int widest = 0;
  int highest = 0;
  for (const Supernode& s : symbolic.supernodes) {
    widest = std::max(widest, s.width);
    highest = std::max(highest, s.height);
  }
  packed_.resize(at(widest) * (B * B));
  gathered_.resize(at(highest) * B);
}

template <int B>
void BlockCholesky<B>::clear() {
  std::fill(panels_.begin(), panels_.end(), 0.0);
}

template <int B>
BlockPlace BlockCholesky<B>::place(int node_a, int node_b) const {
  const auto [column, row] =
      std::minmax(symbolic_->position[at(node_a)], symbolic_->position[at(node_b)]);
  const Supernode& s = symbolic_->supernodes[at(symbolic_->supernode_of[at(column)])];
  const int stride = s.panel_rows() * B;
  return {s.panel * (B * B) + at((column - s.first) * B) * at(stride) +
              at(symbolic_->panel_row(row, s) * B),
          stride};
}

template <int B>
bool BlockCholesky<B>::factorise() {
  Factorisation<B> run{*symbolic_, panels_.data(), signs_.data(), packed_.data()};
  const bool done = run_for_processor(run);
  negative_pivots_ = run.negative;
  return done;
}

template <int B>
void BlockCholesky<B>::solve(double* x) {
  Substitution<B> run{*symbolic_, panels_.data(), signs_.data(), x, gathered_.data()};
  run_for_processor(run);
}

template class BlockCholesky<1>;
template class BlockCholesky<2>;
template class BlockCholesky<3>;

}  // namespace fathom::sparse_gauss_newton
