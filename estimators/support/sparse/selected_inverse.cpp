#include "estimators/support/sparse/selected_inverse.hpp"

#include <algorithm>

#include "estimators/support/sparse/dense_kernel.hpp"

namespace fathom::sparse {
namespace {

constexpr int B = 3;

// Column-major dense matrices that every supernode uses in turn.
struct Workspace {
  std::vector<double> below;    // Σ₂₂, both triangles
  std::vector<double> Y;        // height × width
  std::vector<double> Y_rows;   // the same by rows
  std::vector<double> inverse;  // L₁₁⁻¹
  std::vector<double> packed;   // right side of a product
};

struct Recursion {
  const Symbolic& symbolic;
  double* panels;  // of supernodes that are done Σ, of the others L
  Workspace& work;

  FATHOM_INLINE void gather_below(const Supernode& s) const {
    const int height = s.height * B;
    double* below = work.below.data();
    for (int i = s.updates; i < s.updates + s.update_count; ++i) {
      const Update& u = symbolic.updates[at(i)];
      const Supernode& t = symbolic.supernodes[at(u.target)];
      const int stride = t.panel_rows() * B;
      const int* places = symbolic.places.data() + u.places - u.begin;
      for (int column = u.begin; column < u.end; ++column) {
        const double* from =
            panels + t.panel * kBlockNumbers<B> + at(places[column] * B) * at(stride);
        for (int row = column; row < s.height; ++row) {
          const double* block = from + at(places[row] * B);
          for (int b = 0; b < B; ++b) {
            for (int a = 0; a < B; ++a) {
              const double value = block[a + b * stride];
              below[(row * B + a) + at(column * B + b) * at(height)] = value;
              below[(column * B + b) + at(row * B + a) * at(height)] = value;
            }
          }
        }
      }
    }
  }

  // L₁₁⁻¹ by columns, zero above the diagonal.
  FATHOM_INLINE void invert_top(const double* panel, int stride, int width) const {
    double* inverse = work.inverse.data();
    std::fill(inverse, inverse + at(width) * at(width), 0.0);
    for (int j = 0; j < width; ++j) {
      double* column = inverse + at(j) * at(width);
      column[j] = 1.0;
      for (int k = j; k < width; ++k) {
        const double* L = panel + at(k) * at(stride);
        const double value = column[k] /= L[k];
        for (int i = k + 1; i < width; ++i) column[i] -= L[i] * value;
      }
    }
  }

  // Y = L₂₁ L₁₁⁻¹, column by column from the last.
  FATHOM_INLINE void solve_Y(const double* panel, int stride, int width, int height) const {
    double* Y = work.Y.data();
    for (int j = width - 1; j >= 0; --j) {
      const double* L = panel + at(j) * at(stride);
      double* y = Y + at(j) * at(height);
      for (int i = 0; i < height; ++i) y[i] = L[width + i];
      for (int k = j + 1; k < width; ++k) {
        const double* other = Y + at(k) * at(height);
        for (int i = 0; i < height; ++i) y[i] -= L[k] * other[i];
      }
      for (int i = 0; i < height; ++i) y[i] /= L[j];
    }
    for (int i = 0; i < height; ++i) {
      for (int j = 0; j < width; ++j) {
        work.Y_rows[at(j) + at(i) * at(width)] = Y[at(i) + at(j) * at(height)];
      }
    }
  }

  // Three columns from `from` on, by rows, as the right side of a product.
  FATHOM_INLINE void pack(const double* from, int stride, int rows) const {
    for (int k = 0; k < rows; ++k) {
      for (int j = 0; j < B; ++j) work.packed[at(k * B + j)] = from[k + j * stride];
    }
  }

  // to (rows × 3) ∓= A (rows × depth) · packed.
  FATHOM_INLINE void subtract_product(const double* A, int A_stride, int rows, int depth,
                                      double* to, int stride) const {
    alignas(32) double out[kTileRows * B];
    for (int row = 0; row < rows; row += kTileRows) {
      const int count = std::min(kTileRows, rows - row);
      multiply_rows<B>(count, A + row, A_stride, work.packed.data(), depth, out);
      for (int j = 0; j < B; ++j) {
        for (int i = 0; i < count; ++i) to[row + i + j * stride] -= out[i + j * kTileRows];
      }
    }
  }

  FATHOM_INLINE void invert(const Supernode& s) const {
    const int stride = s.panel_rows() * B;
    const int width = s.width * B;
    const int height = s.height * B;
    double* result = panels + s.panel * kBlockNumbers<B>;
    gather_below(s);
    invert_top(result, stride, width);
    solve_Y(result, stride, width, height);
    // L of this supernode is not needed any more.
    const double* inverse = work.inverse.data();
    for (int j = 0; j < width; ++j) {
      for (int i = 0; i < width; ++i) {
        double sum = 0.0;
        for (int k = std::max(i, j); k < width; ++k) {
          sum += inverse[at(k) + at(i) * at(width)] * inverse[at(k) + at(j) * at(width)];
        }
        result[at(i) + at(j) * at(stride)] = sum;
      }
    }
    for (int column = 0; column < width; column += B) {
      double* to = result + at(column) * at(stride);
      for (int j = 0; j < B; ++j) {
        double* start = to + at(j * stride);
        std::fill(start + width, start + stride, 0.0);
      }
      pack(work.Y.data() + at(column) * at(height), height, height);
      subtract_product(work.below.data(), height, height, height, to + width, stride);
      pack(to + width, stride, height);
      subtract_product(work.Y_rows.data(), width, width, height, to, stride);
    }
  }

  FATHOM_INLINE bool run() {
    for (std::size_t i = symbolic.supernodes.size(); i > 0; --i) {
      invert(symbolic.supernodes[i - 1]);
    }
    return true;
  }
};

Workspace workspace_for(const Symbolic& symbolic) {
  std::size_t width = 0;
  std::size_t height = 0;
  for (const Supernode& s : symbolic.supernodes) {
    width = std::max(width, at(s.width * B));
    height = std::max(height, at(s.height * B));
  }
  Workspace work;
  work.below.resize(height * height + kReadAhead);
  work.Y.resize(height * width);
  work.Y_rows.resize(height * width + kReadAhead);
  work.inverse.resize(width * width);
  work.packed.resize(height * B);
  return work;
}

}  // namespace

SelectedInverse::SelectedInverse(const BlockCholesky<3>& factor)
    : factor_(&factor),
      symbolic_(&factor.symbolic()),
      own_(factor.data(), factor.data() + symbolic_->panel_blocks * kBlockNumbers<B>),
      panels_(own_.data()) {
  run(own_.data());
}

SelectedInverse::SelectedInverse(const BlockCholesky<3>& factor, double* panels)
    : factor_(&factor), symbolic_(&factor.symbolic()), panels_(panels) {
  run(panels);
}

SelectedInverse SelectedInverse::in_place_of(BlockCholesky<3>& factor) {
  return {factor, factor.data()};
}

void SelectedInverse::run(double* panels) const {
  if (symbolic_->supernodes.empty()) return;
  Workspace work = workspace_for(*symbolic_);
  Recursion recursion{*symbolic_, panels, work};
  run_for_processor(recursion);
}

Eigen::Matrix3d SelectedInverse::block(int node) const {
  const int column = symbolic_->position[at(node)];
  const Supernode& s = symbolic_->supernodes[at(symbolic_->supernode_of[at(column)])];
  const int stride = s.panel_rows() * B;
  const int local = (column - s.first) * B;
  const double* from = panels_ + s.panel * kBlockNumbers<B> + at(local) * at(stride) + local;
  Eigen::Matrix3d result;
  for (int a = 0; a < B; ++a) {
    for (int b = 0; b <= a; ++b) result(a, b) = result(b, a) = from[a + b * stride];
  }
  return result;
}

Eigen::Matrix3d SelectedInverse::block(int a, int b) const {
  const BlockPlace place = factor_->place(a, b);
  const bool a_is_row = symbolic_->position[at(a)] > symbolic_->position[at(b)];
  Eigen::Matrix3d result;
  for (int row = 0; row < B; ++row) {
    for (int column = 0; column < B; ++column) {
      const double value = panels_[place.offset + at(row + column * place.stride)];
      (a_is_row ? result(row, column) : result(column, row)) = value;
    }
  }
  return result;
}

}  // namespace fathom::sparse
