#pragma once

#include <vector>

#include "estimators/support/sparse/ordering.hpp"

namespace fathom::incremental_smoother {

using sparse::at;

/// What is estimated, three numbers each: variable k is the pose of keyframe k, and ~k are the
/// errors n of its picture, in units of their standard deviations, where they are unknowns
/// (docs/shared_errors.md).
constexpr int errors_of(int keyframe) {
  return ~keyframe;
}
constexpr bool is_errors(int variable) {
  return variable < 0;
}
constexpr int keyframe_of(int variable) {
  return is_errors(variable) ? ~variable : variable;
}

/// A value of each; there may be fewer of errors than of poses.
template <class T>
struct ByVariable {
  std::vector<T> poses;     ///< by keyframe
  std::vector<T> errors{};  ///< by keyframe

  T& operator[](int v) { return is_errors(v) ? errors[at(~v)] : poses[at(v)]; }
  const T& operator[](int v) const { return is_errors(v) ? errors[at(~v)] : poses[at(v)]; }

  /// New ones are of this value.
  void resize(std::size_t pose_count, std::size_t error_count, const T& value = {}) {
    poses.resize(pose_count, value);
    errors.resize(error_count, value);
  }
  void fill(const T& value) {
    poses.assign(poses.size(), value);
    errors.assign(errors.size(), value);
  }
};

/// The same for loops that are compiled for a processor.
template <class T>
struct VariablePointer {
  T* poses;
  T* errors;

  [[gnu::always_inline]] T& operator[](int v) const { return is_errors(v) ? errors[~v] : poses[v]; }
};

template <class T>
VariablePointer<T> pointer_to(ByVariable<T>& values) {
  return {values.poses.data(), values.errors.data()};
}

}  // namespace fathom::incremental_smoother
