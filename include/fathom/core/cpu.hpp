#pragma once

#if defined(__x86_64__)
#include <immintrin.h>
#endif

/// CPU dispatch: which vector units the processor has beyond those that the compiler may count on.
///
/// A kernel is one always-inlined template. A function marked FATHOM_FOR_AVX2 or FATHOM_FOR_AVX512
/// instantiates it for that unit and is called where `has_avx2()` or `has_avx512()` says so; the
/// plain instantiation serves every other processor. Only here stand names of an architecture: on
/// one other than x86-64 the marks are empty and the answers a constant `false`.
namespace fathom {

#if defined(__x86_64__)
#define FATHOM_FOR_AVX2 [[gnu::target("avx2,fma")]]
#define FATHOM_FOR_AVX512 [[gnu::target("avx512f")]]
#define FATHOM_FOR_AVX512_VNNI [[gnu::target("avx512f,avx512vnni")]]

/// AVX2 and FMA.
inline bool has_avx2() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}
/// AVX-512 F.
inline bool has_avx512() {
  return __builtin_cpu_supports("avx512f") != 0;
}
/// AVX-512 F and its products of bytes.
inline bool has_avx512_vnni() {
  return has_avx512() && __builtin_cpu_supports("avx512vnni") != 0;
}

/// Adds to each of 16 sums the products of four bytes: those of `a` without a sign, those of `b`
/// with one. For the processors of has_avx512_vnni() alone.
using SixteenInts = int __attribute__((vector_size(64)));
FATHOM_FOR_AVX512_VNNI inline void add_byte_products(SixteenInts& sums, const SixteenInts& a,
                                                     const SixteenInts& b) {
  sums = reinterpret_cast<SixteenInts>(_mm512_dpbusd_epi32(
      reinterpret_cast<__m512i>(sums), reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b)));
}
#else
#define FATHOM_FOR_AVX2
#define FATHOM_FOR_AVX512
#define FATHOM_FOR_AVX512_VNNI

constexpr bool has_avx2() {
  return false;
}
constexpr bool has_avx512() {
  return false;
}
constexpr bool has_avx512_vnni() {
  return false;
}

using SixteenInts = int __attribute__((vector_size(64)));
inline void add_byte_products(SixteenInts& /*sums*/, const SixteenInts& /*a*/,
                              const SixteenInts& /*b*/) {}
#endif

}  // namespace fathom
