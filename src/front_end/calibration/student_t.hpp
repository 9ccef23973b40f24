#pragma once

#include <cmath>

namespace fathom {

/// Student's t of so many dimensions with four degrees of freedom: near normal, with some that are
/// far off. r² is a residual's square in units of the scale.
struct StudentT {
  static constexpr double kFreedom = 4.0;
  double dimensions = 1.0;

  /// What a residual weighs in least squares that maximise the likelihood.
  double weight(double r2) const { return (kFreedom + dimensions) / (kFreedom + r2); }
  /// By which the gradient grows with a residual, in the mean over its directions: less than its
  /// weight, as that falls.
  double curvature(double r2) const {
    return weight(r2) * (1.0 - 2.0 / dimensions * r2 / (kFreedom + r2));
  }
  /// Without what the scale adds, and up to a constant.
  double log_density(double r2) const {
    return -0.5 * (kFreedom + dimensions) * std::log1p(r2 / kFreedom);
  }
};

/// Medians of |x| of a standard normal, and of the length of two of them.
inline constexpr double kHalfNormalMedian = 0.674489750196;
inline constexpr double kRayleighMedian = 1.17741002252;

}  // namespace fathom
