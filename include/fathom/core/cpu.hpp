#pragma once

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

/// AVX2 and FMA.
inline bool has_avx2() {
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
}
/// AVX-512 F.
inline bool has_avx512() {
  return __builtin_cpu_supports("avx512f") != 0;
}
#else
#define FATHOM_FOR_AVX2
#define FATHOM_FOR_AVX512

constexpr bool has_avx2() {
  return false;
}
constexpr bool has_avx512() {
  return false;
}
#endif

}  // namespace fathom
