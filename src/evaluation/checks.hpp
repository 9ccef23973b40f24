#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

inline void require_same_length(std::size_t estimate, std::size_t reference,
                                const std::string& what) {
  if (estimate == reference) return;
  throw InputError("the estimate has " + std::to_string(estimate) + " poses and " + what + " " +
                   std::to_string(reference) + "; they must be equally many, one per keyframe");
}

inline void require_finite(std::span<const double> values, const std::string& what) {
  for (const double value : values) {
    if (!std::isfinite(value)) {
      throw InputError(what + " needs finite values, got " + std::to_string(value));
    }
  }
}

inline bool all_finite(std::span<const Pose> poses) {
  for (const Pose& pose : poses) {
    if (!is_finite(pose)) return false;
  }
  return true;
}

}  // namespace fathom
