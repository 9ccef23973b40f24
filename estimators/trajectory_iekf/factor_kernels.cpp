#include "estimators/trajectory_iekf/factor_kernels.hpp"

#include <cstring>

#include "fathom/core/cpu.hpp"

namespace fathom {
namespace {

// By the vector extension of g++ and clang++.
using TwoDoubles = double __attribute__((vector_size(16)));
using FourDoubles = double __attribute__((vector_size(32)));

// So many numbers of a column ahead of use are asked for: a column goes over many pages, and at
// each the memory waits otherwise.
constexpr Eigen::Index kAhead = 256;
constexpr Eigen::Index kDoublesPerLine = 8;

template <class Doubles>
constexpr Eigen::Index kLanes = static_cast<Eigen::Index>(sizeof(Doubles) / sizeof(double));

template <class Doubles>
[[gnu::always_inline]] inline void load(const double* from, Doubles& to) {
  std::memcpy(&to, from, sizeof(to));
}

template <class Doubles>
[[gnu::always_inline]] inline void load_three(const ThreeColumns& V, Eigen::Index row,
                                              Doubles (&to)[3]) {
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) load(V.data + V.stride * c + row, to[c]);
  if (row % kDoublesPerLine != 0) return;
#pragma GCC unroll 3
  for (int c = 0; c < 3; ++c) __builtin_prefetch(V.data + V.stride * c + row + kAhead, 0, 2);
}

template <class Doubles>
[[gnu::always_inline]] inline void transposed_product_with(const ThreeColumns& V,
                                                           const ThreeColumns& B, Eigen::Index rows,
                                                           Eigen::Matrix3d& product) {
  Doubles sums[3][3] = {};
  Eigen::Index row = 0;
  for (; row + kLanes<Doubles> <= rows; row += kLanes<Doubles>) {
    Doubles v[3];
    load_three(V, row, v);
#pragma GCC unroll 3
    for (int q = 0; q < 3; ++q) {
      Doubles b;
      load(B.data + B.stride * q + row, b);
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c) sums[c][q] += v[c] * b;
    }
  }
  for (int c = 0; c < 3; ++c) {
    for (int q = 0; q < 3; ++q) {
      double sum = 0.0;
      for (Eigen::Index lane = 0; lane < kLanes<Doubles>; ++lane) sum += sums[c][q][lane];
      for (Eigen::Index i = row; i < rows; ++i) {
        sum += V.data[V.stride * c + i] * B.data[B.stride * q + i];
      }
      product(c, q) = sum;
    }
  }
}

template <class Doubles>
[[gnu::always_inline]] inline void subtract_product_with(const ThreeColumns& V,
                                                         const Eigen::Matrix3d& Y,
                                                         Eigen::Index rows, double* product,
                                                         Eigen::Index stride) {
  Eigen::Index row = 0;
  for (; row + kLanes<Doubles> <= rows; row += kLanes<Doubles>) {
    Doubles v[3];
    load_three(V, row, v);
#pragma GCC unroll 3
    for (int q = 0; q < 3; ++q) {
      Doubles p;
      load(product + stride * q + row, p);
#pragma GCC unroll 3
      for (int c = 0; c < 3; ++c) p -= v[c] * Y(c, q);
      std::memcpy(product + stride * q + row, &p, sizeof(p));
    }
  }
  for (; row < rows; ++row) {
    for (int q = 0; q < 3; ++q) {
      for (int c = 0; c < 3; ++c) product[stride * q + row] -= V.data[V.stride * c + row] * Y(c, q);
    }
  }
}

FATHOM_FOR_AVX2 void transposed_product_by_avx2(const ThreeColumns& V, const ThreeColumns& B,
                                                Eigen::Index rows, Eigen::Matrix3d& product) {
  transposed_product_with<FourDoubles>(V, B, rows, product);
}

FATHOM_FOR_AVX2 void subtract_product_by_avx2(const ThreeColumns& V, const Eigen::Matrix3d& Y,
                                              Eigen::Index rows, double* product,
                                              Eigen::Index stride) {
  subtract_product_with<FourDoubles>(V, Y, rows, product, stride);
}

}  // namespace

Eigen::Matrix3d transposed_product(const ThreeColumns& V, const ThreeColumns& B,
                                   Eigen::Index rows) {
  Eigen::Matrix3d product;
  if (has_avx2()) {
    transposed_product_by_avx2(V, B, rows, product);
  } else {
    transposed_product_with<TwoDoubles>(V, B, rows, product);
  }
  return product;
}

void subtract_product(const ThreeColumns& V, const Eigen::Matrix3d& Y, Eigen::Index rows,
                      double* product, Eigen::Index stride) {
  if (has_avx2()) return subtract_product_by_avx2(V, Y, rows, product, stride);
  subtract_product_with<TwoDoubles>(V, Y, rows, product, stride);
}

}  // namespace fathom
