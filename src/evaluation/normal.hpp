#pragma once

#include <cmath>
#include <numbers>

#include "fathom/core/chi_squared.hpp"

namespace fathom {

inline double normal_cdf(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// 0 < probability < 1.
inline double normal_quantile(double probability) {
  if (probability == 0.5) return 0.0;
  // The square of a standard normal is χ² of one degree of freedom.
  const double z = std::sqrt(chi_squared_quantile(std::abs(2.0 * probability - 1.0), 1.0));
  return std::copysign(z, probability - 0.5);
}

}  // namespace fathom
